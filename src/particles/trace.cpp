#include "particles/trace.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/per_thread.hpp"
#include "base/tuning.hpp"
#include "particles/bounce.hpp"
#include "particles/path_block.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

namespace {

constexpr std::size_t kPathBlock = PathBlock::kPaths;

class Tracing {
 public:
  Tracing(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission, Particles& particles,
          int maxDepth, std::span<const std::uint32_t> only)
      : tracer_(tracer),
        emission_(emission),
        particles_(particles),
        surfaces_(scene),
        maxDepth_(maxDepth),
        only_(only),
        far_(static_cast<float>(farDistance(scene))) {}

  void trace(std::size_t begin, std::size_t end, PathBlock& r) {
    r.begin(end - begin);
    auto& [walkers, going, rays, hits, first] = memory_.local();
    emit(begin, end, first, walkers, r);
    going.resize(walkers.size());
    std::iota(going.begin(), going.end(), 0u);
    if (rays.size() < walkers.size()) rays.resize(walkers.size()), hits.resize(walkers.size());
    while (!going.empty()) {
      std::size_t alive = 0;
      const Walker& foremost = walkers[going.front()];
      EventSequence numbers(foremost.key, foremost.depth);
      std::uint64_t now = foremost.key;
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

    // Part by part: what was just written in parts stalls when it is copied as a whole.
    void arrive(PrimitiveId primitive, std::uint32_t triangle, const Vec3f& position, const Vec3f& normal, bool front) {
      spot.primitive = primitive, spot.triangle = triangle, spot.front = front;
      spot.position = position, spot.normal = normal;
    }
  };
  /// Of a thread, used again by its next block.
  struct Memory {
    std::vector<Walker> walkers;
    std::vector<std::uint32_t> going;  // places of those on their way
    std::vector<tracing::Ray> rays;
    std::vector<tracing::Hit> hits;
    struct First {
      std::vector<FirstSegment> segments;
      std::vector<LinkEnds> ends;
      std::vector<FirstHit> arrivals;
      FirstRays rays;
    } first;
  };

  std::size_t pathAt(std::size_t i) const { return only_.empty() ? i : only_[i]; }

  void emit(std::size_t begin, std::size_t end, Memory::First& memory, std::vector<Walker>& walkers,
            PathBlock& r) const {
    const std::size_t count = end - begin;
    auto& [segments, ends, arrivals, rays] = memory;
    segments.resize(count), ends.resize(count), arrivals.resize(count);
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
    walkers.clear(), walkers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const FirstSegment& s = segments[i];
      if (s.kind == FirstSegment::Kind::None) continue;
      const auto path = static_cast<std::uint32_t>(i);
      const FirstHit& a = arrivals[i];
      r.addVertex(path, s.origin, {});
      if (!a.primitive.valid()) {
        if (s.kind == FirstSegment::Kind::Open) r.termination[path] = kFirstEnd;
        r.addVertex(path,
                    s.kind == FirstSegment::Kind::Target ? Vec3f(s.target)
                    : std::isfinite(a.distance)          ? a.position
                                                         : s.origin + far_ * s.direction,
                    a.blocker);
        continue;
      }
      r.addVertex(path, a.position, a.primitive);
      r.termination[path] = kArrived | kFirstEnd;
      start(walkers.emplace_back(), pathAt(begin + i), path, a, r);
    }
  }

  void start(Walker& w, std::size_t global, std::uint32_t path, const FirstHit& a, PathBlock& r) const {
    const ParticleLink& link = particles_.links[particles_.link[global]];
    w.path = path;
    w.index = static_cast<std::uint32_t>(global - link.firstPath);
    w.key = link.key;
    w.throughput = a.flux;
    w.direction = a.direction;
    w.arrive(a.primitive, a.triangle, a.position, a.normal, a.front());
    if (!surfaces_.takes(w.spot.primitive, w.spot.front)) r.accounts[path].entered = w.throughput;
    if (!w.spot.front && surfaces_.body(w.spot.primitive)) {
      w.medium = w.spot.primitive;
      if (std::isfinite(a.distance)) absorb(w, a.distance, r);
    }
  }

  void absorb(Walker& w, float distance, PathBlock& r) const {
    const Rgb before = w.throughput;
    w.throughput *= glm::pow(surfaces_.body(w.medium)->transmission, Rgb(distance));
    r.accounts[w.path].absorbed += before - w.throughput;
  }

  /// The next event at the walker's surface; false when the path ends there.
  bool bounce(Walker& w, const EventNumbers& u, tracing::Ray& ray, PathBlock& r) const {
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
      r.termination[w.path] |= kCut;
      r.accounts[w.path].left += w.throughput;
      return false;
    }
    ray.direction = w.direction;
    ray.origin = tracing::offsetOrigin(w.spot.position, w.spot.normal, ray.direction);
    return true;
  }

  void book(const Walker& w, const Rgb& before, PathBlock::Account& account) const {
    if (surfaces_.takes(w.spot.primitive, w.spot.front)) {
      account.passed += w.throughput;
    } else if (w.depth == 0 && surfaces_.isPaneAt(w.spot.primitive)) {
      account.entered = w.throughput;  // of a pane's light this path is what it reflects
    } else {
      // What passes the first surface straight is no path's.
      const Rgb met = w.depth == 0 ? (Rgb(1.0f) - surfaces_.passage(w.spot.primitive, w.spot.front)) * before : before;
      if (w.depth == 0) account.entered = met;
      account.absorbed += met - w.throughput;
    }
  }

  /// Russian roulette on what the path carries relative to what it began with; colours are kept.
  bool survives(Walker& w, double u) const {
    double chance = std::min(1.0, double(maxChannel(w.throughput)) / (tuning::kWorth * w.first));
    if (w.depth > deltalux::tuning::kRouletteFrom) chance = std::min(chance, deltalux::tuning::kMostSurvival);
    if (!(u < chance)) return false;
    w.throughput *= static_cast<float>(1 / chance);
    return true;
  }

  /// Where the walker arrives next; false when the path ends there.
  bool meet(Walker& w, const tracing::Hit& hit, PathBlock& r) const {
    if (!hit) {
      r.addVertex(w.path, w.spot.position + far_ * w.direction, {});
      r.accounts[w.path].left += w.throughput;
      return false;
    }
    if (w.medium.valid()) absorb(w, hit.t, r);
    r.addVertex(w.path, hit.position, hit.primitive);
    w.arrive(hit.primitive, hit.triangle, hit.position, hit.normal, hit.front);
    const bool takes = surfaces_.takes(hit.primitive, hit.front);
    if (takes) r.addDeposit(w.path, hit, surfaces_.parameters(hit), w.throughput);
    if (surfaces_.passesOn(hit.primitive, hit.front)) return true;
    if (!takes) r.accounts[w.path].absorbed += w.throughput;
    return false;
  }

  const tracing::RayTracer& tracer_;
  const ParticleEmission& emission_;
  Particles& particles_;
  ParticleSurfaces surfaces_;
  int maxDepth_;
  std::span<const std::uint32_t> only_;  // paths, or all of them
  float far_;
  PerThread<Memory> memory_;  // batches of rays as small as ours are traced in no loop of their own
};

/// Room for what `count` paths make when `done` of them have made what there is by now.
template <class... Arrays>
void reserveFor(std::size_t count, std::size_t done, std::size_t before, Arrays&... arrays) {
  constexpr double kSpare = 1.05;  // [task]
  const auto reserve = [&](auto& array) {
    const double more = kSpare * static_cast<double>(array.size() - before) * static_cast<double>(count - done) /
                        static_cast<double>(done);
    if (array.size() + static_cast<std::size_t>(more) > array.capacity())
      array.reserve(array.size() + static_cast<std::size_t>(more));
  };
  (reserve(arrays), ...);
}

void trace(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
           Particles& p, std::span<const std::uint32_t> only, std::size_t count) {
  DELTALUX_CHECK(maxDepth < 0xffff, "at most 65534 events");
  constexpr std::size_t kTogether = 128;  // blocks whose memory is used again by the next [task]
  Tracing tracing(scene, tracer, emission, p, maxDepth, only);
  std::vector<PathBlock> blocks(std::min(kTogether, (count + kPathBlock - 1) / kPathBlock));
  const std::size_t vertices = p.vertices.size(), impacts = p.impactSlots();
  for (std::size_t first = 0; first < count; first += kTogether * kPathBlock) {
    const std::size_t some = std::min(kTogether * kPathBlock, count - first);
    parallelBlocks(some, kPathBlock, [&](std::size_t begin, std::size_t end) {
      tracing.trace(first + begin, first + end, blocks[begin / kPathBlock]);
    });
    append(std::span(blocks).first((some + kPathBlock - 1) / kPathBlock), first, only, p);
    reserveFor(count, first + some, vertices, p.vertices, p.met);
    reserveFor(count, first + some, impacts, p.primitive, p.triangleAndSide, p.uv, p.throughput);
  }
}

}  // namespace

void tracePaths(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
                Particles& p) {
  trace(scene, tracer, emission, maxDepth, p, {}, p.paths());
}

void retracePaths(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission, int maxDepth,
                  Particles& p, std::span<const std::uint32_t> paths) {
  if (!paths.empty()) trace(scene, tracer, emission, maxDepth, p, paths, paths.size());
}

}  // namespace deltalux::particles
