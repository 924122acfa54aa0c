#include "particles/trace.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "particles/bounce.hpp"
#include "particles/path_block.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 512;

class Tracing {
 public:
  Tracing(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, Particles& particles,
          int maxDepth, std::span<const std::uint32_t> only)
      : tracer_(tracer),
        emission_(emission),
        particles_(particles),
        surfaces_(scene),
        maxDepth_(maxDepth),
        only_(only),
        far_(static_cast<float>(farDistance(scene))) {}

  void trace(std::size_t begin, std::size_t end, PathBlock& r) const {
    r.begin(end - begin);
    std::vector<Walker> walkers = emit(begin, end, r);
    std::vector<std::uint32_t> going(walkers.size());  // places of those on their way
    std::iota(going.begin(), going.end(), 0u);
    std::vector<Ray> rays(walkers.size());
    std::vector<Hit> hits(walkers.size());
    while (!going.empty()) {
      std::size_t alive = 0;
      const Walker& first = walkers[going.front()];
      EventSequence numbers(first.key, first.depth);
      std::uint64_t now = first.key;
      for (const std::uint32_t i : going) {
        Walker& w = walkers[i];
        if (w.key != now) now = w.key, numbers = EventSequence(w.key, w.depth);
        if (bounce(w, numbers(w.index), rays[alive], r)) going[alive++] = i;
      }
      going.resize(alive);
      tracer_.closestHits(std::span(rays).first(alive), std::span(hits).first(alive));
      r.rays += alive;
      std::size_t left = 0;
      for (std::size_t i = 0; i < alive; ++i)
        if (meet(walkers[going[i]], hits[i], r)) going[left++] = going[i];
      going.resize(left);
    }
  }

 private:
  struct Walker {
    std::uint32_t path = 0, index = 0;  // in the block; sample of its link
    std::uint64_t key = 0;
    float first = 0;  // brightest throughput behind the first event
    int depth = 0;
    Rgb throughput{0.0f};
    Vec3f direction{0.0f};
    SurfaceSpot spot;
    PrimitiveId medium;  // dielectric that the path is in
  };

  std::size_t pathAt(std::size_t i) const { return only_.empty() ? i : only_[i]; }

  std::vector<Walker> emit(std::size_t begin, std::size_t end, PathBlock& r) const {
    const std::size_t count = end - begin;
    std::vector<FirstSegment> segments(count);
    std::vector<LinkEnds> ends(count);
    std::vector<Arrival> arrivals(count);
    FirstRays rays;
    EmissionSequence sequence(0);
    std::array<EmissionNumbers, EmissionSequence::kMost> numbers;
    std::size_t from = 0, until = 0;  // paths that there are numbers for
    std::uint32_t now = ~0u;          // link
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t path = pathAt(begin + i);
      const ParticleLink& link = particles_.links[particles_.link[path]];
      if (particles_.link[path] != now) {
        now = particles_.link[path], sequence = EmissionSequence(link.key);
        from = until = path;
      }
      if (path < from || path >= until) {
        const std::size_t last =
            only_.empty() ? std::min<std::size_t>(path + (count - i), link.firstPath + link.paths) : path + 1;
        from = path, until = std::min(last, from + numbers.size());
        sequence(static_cast<std::uint32_t>(from - link.firstPath), std::span(numbers).first(until - from));
      }
      ends[i] = link.ends;
      emission_.sample(link.ends, numbers[path - from], segments[i]);
      particles_.sender[path] = segments[i].senderCell;
      particles_.originTriangle[path] = segments[i].originTriangle;
    }
    emission_.arrive(ends, segments, arrivals, rays, r.rays);
    std::vector<Walker> walkers;
    walkers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const FirstSegment& s = segments[i];
      if (s.kind == FirstSegment::Kind::None) continue;
      const auto path = static_cast<std::uint32_t>(i);
      const Arrival& a = arrivals[i];
      r.addVertex(path, s.origin, {});
      if (!a.primitive.valid()) {
        if (s.kind == FirstSegment::Kind::Open) r.fate[path] = kFirstEnd;
        r.addVertex(path,
                    s.kind == FirstSegment::Kind::Target ? Vec3f(s.target)
                    : std::isfinite(a.distance)          ? a.position
                                                         : s.origin + far_ * s.direction,
                    a.blocker);
        continue;
      }
      r.addVertex(path, a.position, a.primitive);
      r.fate[path] = kArrived | kFirstEnd;
      walkers.push_back(begun(pathAt(begin + i), path, a, r));
    }
    return walkers;
  }

  Walker begun(std::size_t global, std::uint32_t path, const Arrival& a, PathBlock& r) const {
    const ParticleLink& link = particles_.links[particles_.link[global]];
    Walker w;
    w.path = path;
    w.index = static_cast<std::uint32_t>(global - link.firstPath);
    w.key = link.key;
    w.throughput = a.flux;
    w.direction = a.direction;
    w.spot = {a.primitive, a.triangle, a.position, a.normal, a.front()};
    if (!surfaces_.takes(w.spot.primitive, w.spot.front)) r.accounts[path].entered = w.throughput;
    if (!w.spot.front && surfaces_.body(w.spot.primitive)) {
      w.medium = w.spot.primitive;
      if (std::isfinite(a.distance)) absorb(w, a.distance, r);
    }
    return w;
  }

  void absorb(Walker& w, float distance, PathBlock& r) const {
    const Rgb before = w.throughput;
    w.throughput *= glm::pow(surfaces_.body(w.medium)->transmission, Rgb(distance));
    r.accounts[w.path].absorbed += before - w.throughput;
  }

  /// The next event at the walker's surface; false when the path ends there.
  bool bounce(Walker& w, const EventNumbers& u, Ray& ray, PathBlock& r) const {
    const Rgb before = w.throughput;
    const auto event = surfaces_.scatter(w.spot, w.direction, w.depth == 0, u);
    w.throughput = event ? before * event->weight : Rgb(0.0f);
    book(w, before, r.accounts[w.path]);
    if (!event) return false;
    w.direction = event->direction;
    if (event->refracted) w.medium = w.spot.front ? w.spot.primitive : PrimitiveId();
    if (w.depth == 0) {
      w.first = maxChannel(w.throughput);
    } else if (!survives(w, u.roulette)) {
      return false;
    }
    if (!(w.first > 0)) return false;
    if (++w.depth > maxDepth_) {
      r.fate[w.path] |= kCut;
      r.accounts[w.path].left += w.throughput;
      return false;
    }
    ray.direction = w.direction;
    ray.origin = offsetOrigin(w.spot.position, w.spot.normal, ray.direction);
    return true;
  }

  void book(const Walker& w, const Rgb& before, PathBlock::Account& account) const {
    if (surfaces_.takes(w.spot.primitive, w.spot.front)) {
      account.passed += w.throughput;
    } else if (w.depth == 0 && surfaces_.isPane(w.spot.primitive)) {
      account.entered = w.throughput;  // of a pane's light this path is what it reflects
    } else {
      account.absorbed += before - w.throughput;
    }
  }

  /// Russian roulette on what the path carries relative to what it began with; colours are kept. [algorithm 4]
  bool survives(Walker& w, double u) const {
    constexpr int kPatience = 8;
    constexpr double kWorth = 0.25;        // share of it that is still followed without a question
    constexpr double kMostSurvival = 0.9;  // so that light caught between perfect surfaces ends some day
    double chance = std::min(1.0, double(maxChannel(w.throughput)) / (kWorth * w.first));
    if (w.depth > kPatience) chance = std::min(chance, kMostSurvival);
    if (!(u < chance)) return false;
    w.throughput *= static_cast<float>(1 / chance);
    return true;
  }

  /// Where the walker arrives next; false when the path ends there.
  bool meet(Walker& w, const Hit& hit, PathBlock& r) const {
    if (!hit) {
      r.addVertex(w.path, w.spot.position + far_ * w.direction, {});
      r.accounts[w.path].left += w.throughput;
      return false;
    }
    if (w.medium.valid()) absorb(w, hit.t, r);
    r.addVertex(w.path, hit.position, hit.primitive);
    w.spot = {hit.primitive, hit.triangle, hit.position, hit.normal, hit.front};
    const bool takes = surfaces_.takes(hit.primitive, hit.front);
    if (takes) r.addImpact(w.path, hit, surfaces_.parameters(hit), w.throughput);
    if (surfaces_.passesOn(hit.primitive, hit.front)) return true;
    if (!takes) r.accounts[w.path].absorbed += w.throughput;
    return false;
  }

  const RayTracer& tracer_;
  const ParticleEmission& emission_;
  Particles& particles_;
  ParticleSurfaces surfaces_;
  int maxDepth_;
  std::span<const std::uint32_t> only_;  // paths, or all of them
  float far_;
};

PathAccount closed(const PathBlock::Account& a, std::size_t path) {
  const std::uint64_t chance = mix64(path);
  const auto bits = [&](int i) { return static_cast<std::uint32_t>(chance >> 12 * i); };
  return {{a.entered, bits(0)}, {a.passed, bits(1)}, {a.absorbed, bits(2)}, {a.left, bits(3)}};
}

/// Room for what `count` paths make when `done` of them have made what there is by now.
template <class... Arrays>
void reserveFor(std::size_t count, std::size_t done, std::size_t before, Arrays&... arrays) {
  constexpr double kSpare = 1.05;
  const auto reserve = [&](auto& array) {
    const double more = kSpare * static_cast<double>(array.size() - before) * static_cast<double>(count - done) /
                        static_cast<double>(done);
    if (array.size() + static_cast<std::size_t>(more) > array.capacity())
      array.reserve(array.size() + static_cast<std::size_t>(more));
  };
  (reserve(arrays), ...);
}

/// Where the entries of each path go, behind `first`, when those of all are put in the order of paths.
std::vector<std::uint32_t> placesFrom(std::uint32_t first, std::span<const std::uint32_t> counts) {
  std::vector<std::uint32_t> places(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) places[k] = first, first += counts[k];
  return places;
}

/// Puts what blocks of the paths from `begin` on made behind what is there, by path.
void append(std::span<const PathBlock> blocks, std::size_t begin, std::span<const std::uint32_t> only, Particles& p) {
  std::vector<std::size_t> vertex{p.vertices.size()}, impact{p.impactSlots()};
  for (const PathBlock& b : blocks) {
    vertex.push_back(vertex.back() + b.vertices.size());
    impact.push_back(impact.back() + b.primitive.size());
    p.rays += b.rays;
  }
  DELTALUX_CHECK(vertex.back() < 0x100000000ull, "fewer than 2^32 vertices of particles");
  p.vertices.resize(vertex.back());
  p.met.resize(vertex.back());
  p.primitive.resize(impact.back());
  p.triangleAndSide.resize(impact.back());
  p.uv.resize(impact.back());
  p.throughput.resize(impact.back());
  parallelFor(blocks.size(), 1, [&](std::size_t b) {
    const PathBlock& r = blocks[b];
    auto nextVertex = placesFrom(static_cast<std::uint32_t>(vertex[b]), r.vertexCount);
    auto nextImpact = placesFrom(static_cast<std::uint32_t>(impact[b]), r.impactCount);
    for (std::size_t k = 0; k < r.vertexCount.size(); ++k) {
      const std::size_t at = begin + b * kBlock + k, path = only.empty() ? at : only[at];
      p.range[path] = {nextVertex[k], nextImpact[k], static_cast<std::uint16_t>(r.vertexCount[k]),
                       static_cast<std::uint16_t>(r.impactCount[k])};
      p.fate[path] = r.fate[k];
      p.account[path] = closed(r.accounts[k], path);
    }
    for (std::size_t i = 0; i < r.vertexOf.size(); ++i) {
      const std::uint32_t to = nextVertex[r.vertexOf[i]]++;
      p.vertices[to] = r.vertices[i], p.met[to] = r.met[i];
    }
    for (std::size_t i = 0; i < r.impactOf.size(); ++i) {
      const std::uint32_t to = nextImpact[r.impactOf[i]]++;
      p.primitive[to] = r.primitive[i], p.triangleAndSide[to] = r.triangleAndSide[i];
      p.uv[to] = r.uv[i], p.throughput[to] = r.throughput[i];
    }
  });
}

void trace(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, int maxDepth, Particles& p,
           std::span<const std::uint32_t> only, std::size_t count) {
  DELTALUX_CHECK(maxDepth < 0xffff, "at most 65534 events");
  constexpr std::size_t kTogether = 128;  // blocks whose memory is used again by the next
  const Tracing tracing(scene, tracer, emission, p, maxDepth, only);
  std::vector<PathBlock> blocks(std::min(kTogether, (count + kBlock - 1) / kBlock));
  const std::size_t vertices = p.vertices.size(), impacts = p.impactSlots();
  for (std::size_t first = 0; first < count; first += kTogether * kBlock) {
    const std::size_t some = std::min(kTogether * kBlock, count - first);
    parallelBlocks(some, kBlock, [&](std::size_t begin, std::size_t end) {
      tracing.trace(first + begin, first + end, blocks[begin / kBlock]);
    });
    append(std::span(blocks).first((some + kBlock - 1) / kBlock), first, only, p);
    reserveFor(count, first + some, vertices, p.vertices, p.met);
    reserveFor(count, first + some, impacts, p.primitive, p.triangleAndSide, p.uv, p.throughput);
  }
}

}  // namespace

void tracePaths(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
                Particles& p) {
  trace(scene, tracer, emission, maxDepth, p, {}, p.paths());
}

void retracePaths(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
                  Particles& p, std::span<const std::uint32_t> paths) {
  if (!paths.empty()) trace(scene, tracer, emission, maxDepth, p, paths, paths.size());
}

}  // namespace deltalux
