#include "particles/trace.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "particles/bounce.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 2048;

/// What a block of paths made; vertices and impacts in the order in which they happened, then by path.
struct BlockResult {
  std::vector<std::uint32_t> vertexOf, impactOf;  // path within the block
  std::vector<Vec3f> vertices;
  std::vector<PrimitiveId> primitive;
  std::vector<std::uint32_t> triangleAndSide;
  std::vector<glm::vec2> uv;
  std::vector<Rgb> throughput;
  std::vector<std::uint32_t> vertexCount, impactCount;  // per path
  ParticleLedger ledger;
  std::uint64_t rays = 0, arrived = 0, depthLimit = 0;

  void addVertex(std::uint32_t path, const Vec3f& p) { vertexOf.push_back(path), vertices.push_back(p); }
  void addImpact(std::uint32_t path, const Hit& hit, const glm::vec2& at, const Rgb& flux) {
    impactOf.push_back(path);
    primitive.push_back(hit.primitive);
    triangleAndSide.push_back(2 * hit.triangle + (hit.front ? 0 : 1));
    uv.push_back(at);
    throughput.push_back(flux);
  }
};

/// Puts entries that belong to `of` in its order, keeping their own within.
template <class... Arrays>
std::vector<std::uint32_t> sortByPath(const std::vector<std::uint32_t>& of, std::size_t paths, Arrays&... arrays) {
  std::vector<std::uint32_t> counts(paths, 0), place(of.size());
  for (const std::uint32_t p : of) ++counts[p];
  std::vector<std::uint32_t> next(paths, 0);
  for (std::size_t p = 1; p < paths; ++p) next[p] = next[p - 1] + counts[p - 1];
  for (std::size_t i = 0; i < of.size(); ++i) place[i] = next[of[i]]++;
  const auto permute = [&](auto& array) {
    auto sorted = array;
    for (std::size_t i = 0; i < of.size(); ++i) sorted[place[i]] = array[i];
    array = std::move(sorted);
  };
  (permute(arrays), ...);
  return counts;
}

class Tracing {
 public:
  Tracing(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, Particles& particles,
          int maxDepth)
      : tracer_(tracer),
        emission_(emission),
        particles_(particles),
        surfaces_(scene),
        maxDepth_(maxDepth),
        far_(static_cast<float>(4 * coarse(std::max(bounds(scene).diagonal(), 1e-6)))) {}

  BlockResult trace(std::size_t begin, std::size_t end) const {
    BlockResult r;
    std::vector<Walker> walkers = emit(begin, end, r);
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    while (!walkers.empty()) {
      rays.clear();
      std::size_t alive = 0;
      for (Walker& w : walkers) {
        Ray ray;
        if (!bounce(w, ray, r)) continue;
        rays.push_back(ray);
        walkers[alive++] = w;
      }
      walkers.resize(alive);
      hits.resize(alive);
      tracer_.closestHits(rays, hits);
      r.rays += alive;
      std::size_t going = 0;
      for (std::size_t i = 0; i < alive; ++i)
        if (meet(walkers[i], hits[i], r)) walkers[going++] = walkers[i];
      walkers.resize(going);
    }
    const std::size_t paths = end - begin;
    r.vertexCount = sortByPath(r.vertexOf, paths, r.vertices);
    r.impactCount = sortByPath(r.impactOf, paths, r.primitive, r.triangleAndSide, r.uv, r.throughput);
    return r;
  }

 private:
  struct Walker {
    std::uint32_t path = 0, index = 0;  // in the block; sample of its link
    std::uint64_t key = 0;
    float weight = 0;  // nominal flux of unit gray throughput, for the ledger
    float first = 0;   // brightest throughput behind the first event
    int depth = 0;
    Rgb throughput{0.0f};
    Vec3f direction{0.0f};
    SurfaceSpot spot;
    PrimitiveId medium;  // dielectric that the path is in
  };

  std::vector<Walker> emit(std::size_t begin, std::size_t end, BlockResult& r) const {
    const std::size_t count = end - begin;
    std::vector<FirstSegment> segments(count);
    std::vector<LinkEnds> ends(count);
    std::vector<Arrival> arrivals(count);
    for (std::size_t i = 0; i < count; ++i) {
      const ParticleLink& link = particles_.links[particles_.link[begin + i]];
      const auto index = static_cast<std::uint32_t>(begin + i - link.firstPath);
      ends[i] = link.ends;
      segments[i] = emission_.sample(link.ends, emissionNumbers(link.key, index));
      particles_.sender[begin + i] = segments[i].senderCell;
      particles_.originTriangle[begin + i] = segments[i].originTriangle;
    }
    emission_.arrive(ends, segments, arrivals, r.rays);
    std::vector<Walker> walkers;
    walkers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const FirstSegment& s = segments[i];
      if (s.kind == FirstSegment::Kind::None) continue;
      const auto path = static_cast<std::uint32_t>(i);
      const Arrival& a = arrivals[i];
      r.addVertex(path, s.origin);
      if (!a.primitive.valid()) {
        const bool aimed = s.kind == FirstSegment::Kind::Target;
        r.addVertex(path, aimed ? Vec3f(s.target) : s.origin + far_ * s.direction);
        continue;
      }
      r.addVertex(path, a.position);
      ++r.arrived;
      walkers.push_back(begun(begin + i, path, s, a, r));
    }
    return walkers;
  }

  Walker begun(std::size_t global, std::uint32_t path, const FirstSegment& s, const Arrival& a, BlockResult& r) const {
    const ParticleLink& link = particles_.links[particles_.link[global]];
    Walker w;
    w.path = path;
    w.index = static_cast<std::uint32_t>(global - link.firstPath);
    w.key = link.key;
    w.weight = link.scale * particles_.nominal[s.senderCell];
    w.throughput = a.flux;
    w.direction = a.direction;
    w.spot = {a.primitive, a.triangle, a.position, a.normal, a.front()};
    r.ledger.arrived += w.weight * gray(w.throughput);
    if (!w.spot.front && surfaces_.body(w.spot.primitive)) {
      w.medium = w.spot.primitive;
      if (std::isfinite(a.distance)) absorb(w, a.distance, r);
    }
    return w;
  }

  void absorb(Walker& w, float distance, BlockResult& r) const {
    const Rgb before = w.throughput;
    w.throughput *= glm::pow(surfaces_.body(w.medium)->transmission, Rgb(distance));
    r.ledger.absorbed += w.weight * gray(before - w.throughput);
  }

  /// The next event at the walker's surface; false when the path ends there.
  bool bounce(Walker& w, Ray& ray, BlockResult& r) const {
    const float before = gray(w.throughput);
    const EventNumbers u = eventNumbers(w.key, w.index, w.depth);
    const auto event = surfaces_.scatter(w.spot, w.direction, w.depth == 0, u);
    if (!event) {
      r.ledger.absorbed += w.weight * before;
      return false;
    }
    w.throughput *= event->weight;
    w.direction = event->direction;
    r.ledger.absorbed += w.weight * before * (1 - event->passed);
    if (event->refracted) w.medium = w.spot.front ? w.spot.primitive : PrimitiveId();
    if (w.depth == 0) {
      w.first = maxChannel(w.throughput);
    } else if (!survives(w, u.roulette, r)) {
      return false;
    }
    if (!(w.first > 0)) return false;
    if (++w.depth > maxDepth_) {
      ++r.depthLimit;
      r.ledger.ended += w.weight * gray(w.throughput);
      return false;
    }
    ray.direction = w.direction;
    ray.origin = offsetOrigin(w.spot.position, w.spot.normal, ray.direction);
    return true;
  }

  /// Russian roulette on what the path carries relative to what it began with; colours are kept. [algorithm 4]
  bool survives(Walker& w, double u, BlockResult& r) const {
    constexpr int kPatience = 8;
    constexpr double kMostSurvival = 0.9;  // so that light caught between perfect surfaces ends some day
    double chance = std::min(1.0, double(maxChannel(w.throughput)) / w.first);
    if (w.depth > kPatience) chance = std::min(chance, kMostSurvival);
    const float before = gray(w.throughput);
    if (!(u < chance)) {
      r.ledger.roulette += w.weight * before;
      return false;
    }
    w.throughput *= static_cast<float>(1 / chance);
    r.ledger.roulette += w.weight * (before - gray(w.throughput));
    return true;
  }

  /// Where the walker arrives next; false when the path ends there.
  bool meet(Walker& w, const Hit& hit, BlockResult& r) const {
    if (!hit) {
      r.addVertex(w.path, w.spot.position + far_ * w.direction);
      r.ledger.escaped += w.weight * gray(w.throughput);
      return false;
    }
    if (w.medium.valid()) absorb(w, hit.t, r);
    r.addVertex(w.path, hit.position);
    w.spot = {hit.primitive, hit.triangle, hit.position, hit.normal, hit.front};
    if (surfaces_.takes(hit.primitive, hit.front)) {
      r.addImpact(w.path, hit, surfaces_.parameters(hit), w.throughput);
    }
    if (surfaces_.passesOn(hit.primitive, hit.front)) return true;
    r.ledger.absorbed += w.weight * gray(w.throughput);
    return false;
  }

  const RayTracer& tracer_;
  const ParticleEmission& emission_;
  Particles& particles_;
  ParticleSurfaces surfaces_;
  int maxDepth_;
  float far_;
};

void join(std::vector<BlockResult>& blocks, Particles& p) {
  std::vector<std::size_t> vertex{0}, impact{0};
  for (const BlockResult& b : blocks) {
    vertex.push_back(vertex.back() + b.vertices.size());
    impact.push_back(impact.back() + b.primitive.size());
    p.ledger += b.ledger;
    p.rays += b.rays, p.arrived += b.arrived, p.depthLimit += b.depthLimit;
  }
  DELTALUX_CHECK(vertex.back() < 0x100000000ull, "fewer than 2^32 vertices of particles");
  p.vertexBegin.resize(p.paths() + 1);
  p.impactBegin.resize(p.paths() + 1);
  p.vertices.resize(vertex.back());
  p.primitive.resize(impact.back());
  p.triangleAndSide.resize(impact.back());
  p.uv.resize(impact.back());
  p.throughput.resize(impact.back());
  parallelFor(blocks.size(), 1, [&](std::size_t b) {
    BlockResult& r = blocks[b];
    auto v = static_cast<std::uint32_t>(vertex[b]), i = static_cast<std::uint32_t>(impact[b]);
    for (std::size_t k = 0; k < r.vertexCount.size(); ++k) {
      v += r.vertexCount[k], i += r.impactCount[k];
      p.vertexBegin[b * kBlock + k + 1] = v;
      p.impactBegin[b * kBlock + k + 1] = i;
    }
    const auto put = [](const auto& from, auto& to, std::size_t at) {
      std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
    };
    put(r.vertices, p.vertices, vertex[b]);
    put(r.primitive, p.primitive, impact[b]);
    put(r.triangleAndSide, p.triangleAndSide, impact[b]);
    put(r.uv, p.uv, impact[b]);
    put(r.throughput, p.throughput, impact[b]);
    r = {};
  });
}

}  // namespace

void tracePaths(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
                Particles& p) {
  const Tracing tracing(scene, tracer, emission, p, maxDepth);
  std::vector<BlockResult> blocks((p.paths() + kBlock - 1) / kBlock);
  parallelBlocks(p.paths(), kBlock,
                 [&](std::size_t begin, std::size_t end) { blocks[begin / kBlock] = tracing.trace(begin, end); });
  join(blocks, p);
}

}  // namespace deltalux
