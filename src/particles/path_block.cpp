#include "particles/path_block.hpp"

#include <array>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace deltalux::particles {

namespace {

PathAccount closed(const PathBlock::Account& a, std::size_t path) {
  const std::uint64_t chance = mix64(path);
  const auto bits = [&](int i) { return static_cast<std::uint32_t>(chance >> 12 * i); };
  return {{a.entered, bits(0)}, {a.passed, bits(1)}, {a.absorbed, bits(2)}, {a.left, bits(3)}};
}

/// Of each path of a block, where its next entry goes.
using Places = std::array<std::uint32_t, PathBlock::kPaths>;

/// `vertex`, `impact`: where those of the block begin.
void append(const PathBlock& block, std::size_t begin, std::span<const std::uint32_t> only, std::size_t vertex,
            std::size_t impact, Particles& p) {
  Places nextVertex, nextImpact;
  auto v = static_cast<std::uint32_t>(vertex), i = static_cast<std::uint32_t>(impact);
  for (std::size_t k = 0; k < block.vertexCount.size(); ++k) {
    const std::size_t path = only.empty() ? begin + k : only[begin + k];
    nextVertex[k] = v, nextImpact[k] = i;
    p.range[path] = {v, i, static_cast<std::uint16_t>(block.vertexCount[k]),
                     static_cast<std::uint16_t>(block.depositCount[k])};
    p.termination[path] = block.termination[k];
    p.account[path] = block.termination[k] & kArrived ? closed(block.accounts[k], path) : PathAccount{};
    v += block.vertexCount[k], i += block.depositCount[k];
  }
  for (const PathBlock::Vertex& from : block.vertices) {
    const std::uint32_t to = nextVertex[from.path]++;
    p.vertices[to] = from.position, p.met[to] = from.met;
  }
  for (const PathBlock::Deposit& from : block.deposits) {
    const std::uint32_t to = nextImpact[from.path]++;
    p.primitive[to] = from.primitive, p.triangleAndSide[to] = from.triangleAndSide;
    p.uv[to] = from.uv, p.throughput[to] = from.throughput;
  }
}

}  // namespace

void append(std::span<const PathBlock> blocks, std::size_t begin, std::span<const std::uint32_t> only, Particles& p) {
  std::vector<std::size_t> vertex{p.vertices.size()}, impact{p.impactSlots()};
  for (const PathBlock& b : blocks) {
    vertex.push_back(vertex.back() + b.vertices.size());
    impact.push_back(impact.back() + b.deposits.size());
    p.rays += b.rays;
  }
  DELTALUX_CHECK(vertex.back() < 0x100000000ull, "fewer than 2^32 vertices of particles");
  p.vertices.resize(vertex.back());
  p.met.resize(vertex.back());
  p.primitive.resize(impact.back());
  p.triangleAndSide.resize(impact.back());
  p.uv.resize(impact.back());
  p.throughput.resize(impact.back());
  parallelFor(blocks.size(), 1,
              [&](std::size_t b) { append(blocks[b], begin + b * PathBlock::kPaths, only, vertex[b], impact[b], p); });
}

}  // namespace deltalux::particles
