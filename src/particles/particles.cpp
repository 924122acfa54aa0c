#include "particles/particles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/random.hpp"

namespace deltalux::particles {

namespace {

void require(bool holds, std::size_t i, const char* what) {
  if (!holds) throw std::logic_error("particle " + std::to_string(i) + ": " + what);
}

std::uint64_t bitsOf(float x) { return std::bit_cast<std::uint32_t>(x); }

}  // namespace

ParticleLedger Particles::ledger() const {
  ParticleLedger l;
  for (std::size_t p = 0; p < paths(); ++p) {
    const double w = weight(p);
    const PathAccount& a = account[p];
    l.entered += w * gray(a.entered.value()), l.passed += w * gray(a.passed.value());
    l.absorbed += w * gray(a.absorbed.value());
    (termination[p] & kCut ? l.cut : l.escaped) += w * gray(a.left.value());
    for (std::uint32_t i = firstImpact(p); i < endImpact(p); ++i) l.deposited += w * gray(throughput[i]);
  }
  return l;
}

std::uint64_t Particles::arrived() const {
  return static_cast<std::uint64_t>(
      std::count_if(termination.begin(), termination.end(), [](auto f) { return f & kArrived; }));
}

std::uint64_t Particles::cut() const {
  return static_cast<std::uint64_t>(
      std::count_if(termination.begin(), termination.end(), [](auto f) { return f & kCut; }));
}

std::uint64_t Particles::deposited() const {
  std::uint64_t count = 0;
  for (const PathRange& r : range) count += r.impacts > 0;
  return count;
}

std::uint64_t Particles::impacts() const {
  std::uint64_t count = 0;
  for (const PathRange& r : range) count += r.impacts;
  return count;
}

namespace {

/// Moves the entries of all ranges, in the order of the paths, to the front of a new array.
template <class T>
void gather(LargeArray<T>& array, const LargeArray<PathRange>& ranges, std::uint32_t PathRange::*first,
            std::uint16_t PathRange::*count) {
  LargeArray<T> dense;
  for (const PathRange& r : ranges) {
    const auto begin = array.begin() + static_cast<std::ptrdiff_t>(r.*first);
    dense.insert(dense.end(), begin, begin + r.*count);
  }
  array = std::move(dense);
}

}  // namespace

void Particles::makeRoom() {
  const auto grow = [](auto&... arrays) { (arrays.reserve(arrays.size() + arrays.size() / 4), ...); };
  grow(vertices, met, primitive, triangleAndSide, uv, throughput);
}

void Particles::compact() {
  gather(vertices, range, &PathRange::vertex, &PathRange::vertices);
  gather(met, range, &PathRange::vertex, &PathRange::vertices);
  gather(primitive, range, &PathRange::impact, &PathRange::impacts);
  gather(triangleAndSide, range, &PathRange::impact, &PathRange::impacts);
  gather(uv, range, &PathRange::impact, &PathRange::impacts);
  gather(throughput, range, &PathRange::impact, &PathRange::impacts);
  std::uint32_t vertex = 0, impact = 0;
  for (PathRange& r : range) {
    r.vertex = vertex, r.impact = impact;
    vertex += r.vertices, impact += r.impacts;
  }
}

std::size_t Particles::memoryBytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(senderCells) + bytes(links) + bytes(link) + bytes(sender) + bytes(originTriangle) + bytes(range) +
         bytes(account) + bytes(termination) + bytes(vertices) + bytes(met) + bytes(primitive) +
         bytes(triangleAndSide) + bytes(uv) + bytes(throughput);
}

std::uint64_t Particles::hash() const {
  std::uint64_t h = 0;
  const auto take = [&](std::uint64_t x) { h = mix64(h ^ x) + x; };
  for (const ParticleLink& l : links) take(l.key), take(l.paths), take(bitsOf(l.scale));
  for (std::size_t p = 0; p < paths(); ++p) {
    take(std::uint64_t(sender[p]) << 32 | std::uint64_t(range[p].vertices) << 16 | range[p].impacts);
    for (const Vec3f& v : verticesOf(p)) take(bitsOf(v.x) << 32 | bitsOf(v.y)), take(bitsOf(v.z));
    for (std::uint32_t i = firstImpact(p); i < endImpact(p); ++i) {
      take(std::uint64_t(primitive[i].value) << 32 | triangleAndSide[i]);
      take(bitsOf(uv[i].x) << 32 | bitsOf(uv[i].y));
      take(bitsOf(throughput[i].r) << 32 | bitsOf(throughput[i].g)), take(bitsOf(throughput[i].b));
    }
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
  require(p.range.size() == n && p.account.size() == n && p.termination.size() == n, n, "ranges and accounts are kept");
  std::size_t next = 0;
  for (std::size_t l = 0; l < p.links.size(); ++l) {
    const ParticleLink& link = p.links[l];
    require(link.firstPath == next, l, "a link's paths stand behind those of the one before");
    require(link.paths > 0 && link.scale > 0 && std::isfinite(link.scale), l, "a link has paths and a scale");
    require(link.albedo > 0 && std::isfinite(link.albedo), l, "a link leads to what passes light on");
    next += link.paths;
  }
  require(next == n, n, "every path has its link");
  for (std::size_t i = 0; i < n; ++i) {
    require(p.link[i] < p.links.size(), i, "its link is there");
    const ParticleLink& link = p.links[p.link[i]];
    require(i >= link.firstPath && i < link.firstPath + std::size_t(link.paths), i, "its link knows it");
    const PathRange& r = p.range[i];
    require(r.vertex + std::size_t(r.vertices) <= p.vertices.size(), i, "its vertices are there");
    require(r.impact + std::size_t(r.impacts) <= p.impactSlots(), i, "its impacts are there");
    require(r.impacts <= r.vertices, i, "it lands only where it went");
    require(p.sender[i] < p.senderCells.size(), i, "its sender is there");
    const SenderCell& cell = p.senderCells[p.sender[i]];
    require(cell.kind != SenderKind::Side || r.vertices == 0 ||
                p.originTriangle[i] < trianglesOf(scene[cell.primitive].shape),
            i, "its origin is on the sender");
  }
}

void checkImpact(const Particles& p, std::size_t i, const Scene& scene) {
  require(p.primitive[i].index() < scene.primitives.size(), i, "it lands on a surface of the scene");
  require(p.triangleAndSide[i] >> 1 < trianglesOf(scene[p.primitive[i]].shape), i, "it lands on a triangle of it");
  const Rgb& t = p.throughput[i];
  for (int c = 0; c < 3; ++c) require(std::isfinite(t[c]) && t[c] >= 0, i, "throughput is finite and not negative");
  require(std::isfinite(p.uv[i].x) && std::isfinite(p.uv[i].y), i, "parameters are finite");
}

}  // namespace

void validate(const Particles& p, const Scene& scene) {
  checkSenders(p, scene);
  checkPaths(p, scene);
  for (const Vec3f& v : p.vertices)
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), 0, "vertices are finite");
  require(p.met.size() == p.vertices.size(), p.met.size(), "arrays of one length");
  for (const PrimitiveId id : p.met)
    require(!id.valid() || id.index() < scene.primitives.size(), 0, "what a path meets is there");
  const std::size_t n = p.impactSlots();
  require(p.triangleAndSide.size() == n && p.uv.size() == n && p.throughput.size() == n, n, "arrays of one length");
  for (std::size_t path = 0; path < p.paths(); ++path)
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) checkImpact(p, i, scene);
}

}  // namespace deltalux::particles
