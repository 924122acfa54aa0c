#include "particles/particles.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/random.hpp"

namespace deltalux {

namespace {

void require(bool holds, std::size_t i, const char* what) {
  if (!holds) throw std::logic_error("particle " + std::to_string(i) + ": " + what);
}

std::uint64_t bitsOf(float x) { return std::bit_cast<std::uint32_t>(x); }

}  // namespace

ParticleLedger& ParticleLedger::operator+=(const ParticleLedger& o) {
  arrived += o.arrived, absorbed += o.absorbed, escaped += o.escaped, ended += o.ended, roulette += o.roulette;
  return *this;
}

std::uint64_t Particles::landed() const {
  std::uint64_t count = 0;
  for (std::size_t p = 0; p < paths(); ++p) count += impactBegin[p + 1] > impactBegin[p];
  return count;
}

std::size_t Particles::memoryBytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(senderCells) + bytes(links) + bytes(link) + bytes(sender) + bytes(originTriangle) + bytes(vertexBegin) +
         bytes(impactBegin) + bytes(vertices) + bytes(primitive) + bytes(triangleAndSide) + bytes(uv) +
         bytes(throughput);
}

std::uint64_t Particles::hash() const {
  std::uint64_t h = 0;
  const auto take = [&](std::uint64_t x) { h = mix64(h ^ x) + x; };
  for (const ParticleLink& l : links) take(l.key), take(l.paths), take(bitsOf(l.scale));
  for (std::size_t p = 0; p < paths(); ++p) take(std::uint64_t(vertexBegin[p]) << 32 | impactBegin[p]);
  for (const Vec3f& v : vertices) take(bitsOf(v.x) << 32 | bitsOf(v.y)), take(bitsOf(v.z));
  for (std::size_t i = 0; i < impacts(); ++i) {
    take(std::uint64_t(primitive[i].value) << 32 | triangleAndSide[i]);
    take(bitsOf(uv[i].x) << 32 | bitsOf(uv[i].y));
    take(bitsOf(throughput[i].r) << 32 | bitsOf(throughput[i].g)), take(bitsOf(throughput[i].b));
  }
  return h;
}

namespace {

std::size_t trianglesOf(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh ? mesh->triangles.size() : 1;
}

void checkSenders(const Particles& p, const Scene& scene) {
  require(p.nominal.size() == p.senderCells.size(), p.nominal.size(), "every sender has its nominal exitance");
  for (std::size_t i = 0; i < p.senderCells.size(); ++i) {
    const SenderCell& c = p.senderCells[i];
    const bool surface = c.kind == SenderKind::Side;
    require(surface || c.light.index() < scene.lights.size(), i, "its light is there");
    require(!surface || c.primitive.index() < scene.primitives.size(), i, "its surface is there");
  }
}

void checkPaths(const Particles& p, const Scene& scene) {
  const std::size_t n = p.paths();
  require(p.sender.size() == n && p.originTriangle.size() == n, n, "arrays of one length");
  require(p.vertexBegin.size() == n + 1 && p.impactBegin.size() == n + 1, n, "ranges are kept");
  require(p.vertexBegin[0] == 0 && p.impactBegin[0] == 0, 0, "ranges begin at nothing");
  std::size_t next = 0;
  for (std::size_t l = 0; l < p.links.size(); ++l) {
    const ParticleLink& link = p.links[l];
    require(link.firstPath == next, l, "a link's paths stand behind those of the one before");
    require(link.paths > 0 && link.scale > 0 && std::isfinite(link.scale), l, "a link has paths and a scale");
    next += link.paths;
  }
  require(next == n, n, "every path has its link");
  for (std::size_t i = 0; i < n; ++i) {
    require(p.link[i] < p.links.size(), i, "its link is there");
    const ParticleLink& link = p.links[p.link[i]];
    require(i >= link.firstPath && i < link.firstPath + std::size_t(link.paths), i, "its link knows it");
    require(p.vertexBegin[i] <= p.vertexBegin[i + 1] && p.impactBegin[i] <= p.impactBegin[i + 1], i, "ranges ascend");
    require(p.impactBegin[i + 1] - p.impactBegin[i] <= p.vertexBegin[i + 1] - p.vertexBegin[i], i,
            "it lands only where it went");
    require(p.sender[i] < p.senderCells.size(), i, "its sender is there");
    const SenderCell& cell = p.senderCells[p.sender[i]];
    require(cell.kind != SenderKind::Side || p.originTriangle[i] < trianglesOf(scene[cell.primitive].shape), i,
            "its origin is on the sender");
  }
  require(p.vertexBegin.back() == p.vertices.size() && p.impactBegin.back() == p.impacts(), n, "nothing is left over");
}

}  // namespace

void validate(const Particles& p, const Scene& scene) {
  checkSenders(p, scene);
  checkPaths(p, scene);
  for (const Vec3f& v : p.vertices)
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), 0, "vertices are finite");
  const std::size_t n = p.impacts();
  require(p.triangleAndSide.size() == n && p.uv.size() == n && p.throughput.size() == n, n, "arrays of one length");
  for (std::size_t i = 0; i < n; ++i) {
    require(p.primitive[i].index() < scene.primitives.size(), i, "it lands on a surface of the scene");
    require(p.triangleAndSide[i] >> 1 < trianglesOf(scene[p.primitive[i]].shape), i, "it lands on a triangle of it");
    const Rgb& t = p.throughput[i];
    for (int c = 0; c < 3; ++c) require(std::isfinite(t[c]) && t[c] >= 0, i, "throughput is finite and not negative");
    require(std::isfinite(p.uv[i].x) && std::isfinite(p.uv[i].y), i, "parameters are finite");
  }
}

}  // namespace deltalux
