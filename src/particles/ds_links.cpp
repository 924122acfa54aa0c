#include "particles/ds_links.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "particles/bounce.hpp"

namespace deltalux {

namespace {

constexpr int kLooks = 8;
constexpr int kNearLooks = 48;
constexpr double kMostLooks = 2048;
constexpr int kFirstLooks = 512;  // at each root, for the sum of all flux
constexpr double kNear = 0.4;     // radii of both ends over their distance, above which they are near
constexpr double kHopeful = 0.5;  // looks that are taken to have arrived although none did
constexpr double kUneven = 0.5;   // spread of looks, relative to their mean, that is worth a refinement
constexpr double kMuch = 8.0;     // shares of flux from which unevenness counts
constexpr double kLeast = 1e-3;   // shares of flux that any link is taken to carry
constexpr std::uint64_t kLookSeed = 0x6c6f6f6b7a7a7a7aull;

struct Judgement {
  double flux = 0;       // estimate, with hope for what no look found
  double passing = 0;    // share of looks that arrived
  double bound = 0;      // root mean square of looks, had they arrived
  bool arrived = false;  // any
  bool uneven = false;   // looks differ much, or only some of them passed
};

class Judge {
 public:
  Judge(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission, const Senders& senders,
        const Receivers& receivers, const CoarseExitance& exitance)
      : tracer_(tracer),
        emission_(emission),
        senders_(senders),
        receivers_(receivers),
        exitance_(exitance),
        surfaces_(scene) {}

  /// Follows a few samples over their first event to the next surface: what only leaves the scene is worth no particle.
  Judgement look(const LinkEnds& ends, std::uint64_t key, int looks, std::uint64_t& rays) const {
    std::vector<FirstSegment> segments(looks);
    const std::vector<LinkEnds> links(looks, ends);
    std::vector<Arrival> arrivals(looks);
    const std::uint64_t own = combineKeys(key, kLookSeed);
    double bound = 0, boundSquares = 0;
    for (int i = 0; i < looks; ++i) {
      segments[i] = emission_.sample(ends, emissionNumbers(own, static_cast<std::uint32_t>(i)));
      const double b = exitanceOf(segments[i].senderCell) * segments[i].bound * albedoOf(segments[i], ends);
      bound += b, boundSquares += b * b;
    }
    emission_.arrive(links, segments, arrivals, rays);
    double sum = 0, squares = 0;
    int passed = 0;
    for (int i = 0; i < looks; ++i) {
      if (!arrivals[i].primitive.valid()) continue;
      ++passed;
      const double w =
          exitanceOf(segments[i].senderCell) * passedOn(arrivals[i], own, static_cast<std::uint32_t>(i), rays);
      sum += w, squares += w * w;
    }
    Judgement j;
    j.flux = (sum + kHopeful * bound / looks) / (looks + 1);
    j.bound = std::sqrt(boundSquares / looks);
    j.arrived = passed > 0;
    j.passing = (passed + kHopeful) / (looks + 1);
    j.uneven = squares * looks > (1 + kUneven * kUneven) * sum * sum || sum == 0;
    return j;
  }

  bool near(const LinkEnds& ends) const {
    const BoundingSphere &s = senders_.bound(ends.sender), &r = receivers_.bound(ends.receiver);
    const SenderKind kind = kindOf(ends.sender);
    if (kind == SenderKind::Sun) return false;
    if (kind == SenderKind::Sky) return s.radius > kNear;
    return s.radius + r.radius > kNear * glm::distance(s.center, r.center);
  }

  bool splitsSender(const LinkEnds& ends) const {
    const RadixNode &s = senders_.nodes()[ends.sender], &r = receivers_.nodes()[ends.receiver];
    if (s.isLeaf() || r.isLeaf()) return !s.isLeaf();
    if (kindOf(ends.sender) == SenderKind::Sky) {
      const double scene = receivers_.bound(receivers_.root()).radius;
      return senders_.bound(ends.sender).radius * scene > receivers_.bound(ends.receiver).radius;
    }
    return senders_.bound(ends.sender).radius > receivers_.bound(ends.receiver).radius;
  }

  bool divisible(const LinkEnds& ends) const {
    return !senders_.nodes()[ends.sender].isLeaf() || !receivers_.nodes()[ends.receiver].isLeaf();
  }

  std::uint64_t key(const LinkEnds& ends, std::uint64_t seed) const {
    return combineKeys(seed, combineKeys(senders_.nodes()[ends.sender].key, receivers_.nodes()[ends.receiver].key));
  }

 private:
  SenderKind kindOf(std::uint32_t node) const { return senders_.cells()[senders_.nodes()[node].begin].kind; }

  double exitanceOf(std::uint32_t cell) const {
    return senders_.cells()[cell].kind == SenderKind::Side ? exitance_.perCell[cell] : 1.0;
  }
  double albedoOf(const FirstSegment& s, const LinkEnds& ends) const {
    if (s.kind == FirstSegment::Kind::Target) return receivers_.albedo(s.receiverCell);
    return receivers_.albedo(receivers_.nodes()[ends.receiver].begin);
  }
  /// Gray flux behind the first event, if it meets a surface.
  double passedOn(const Arrival& a, std::uint64_t key, std::uint32_t index, std::uint64_t& rays) const {
    const SurfaceSpot spot{a.primitive, a.triangle, a.position, a.normal, a.front()};
    const auto event = surfaces_.scatter(spot, a.direction, true, eventNumbers(key, index, 0));
    if (!event) return 0;
    Ray ray;
    ray.direction = event->direction;
    ray.origin = offsetOrigin(a.position, a.normal, ray.direction);
    ++rays;
    return tracer_.closestHit(ray) ? gray(a.flux * event->weight) : 0;
  }

  const RayTracer& tracer_;
  const ParticleEmission& emission_;
  const Senders& senders_;
  const Receivers& receivers_;
  const CoarseExitance& exitance_;
  ParticleSurfaces surfaces_;
};

}  // namespace

EmissionNumbers emissionNumbers(std::uint64_t key, std::uint32_t index) {
  const UnitPair a = scrambledSobol(index, combineKeys(key, 1)), b = scrambledSobol(index, combineKeys(key, 2)),
                 c = scrambledSobol(index, combineKeys(key, 3));
  return {{a.x, a.y}, {b.x, b.y}, {c.x, c.y}};
}

DsLinks refineDsLinks(const Scene& scene, const RayTracer& tracer, const ParticleEmission& emission,
                      const Senders& senders, const Receivers& receivers, const CoarseExitance& exitance,
                      std::span<const std::uint32_t> senderRoots, const DsSettings& settings) {
  DsLinks links;
  if (receivers.empty()) return links;
  const Judge judge(scene, tracer, emission, senders, receivers, exitance);
  std::vector<LinkEnds> level;
  for (const std::uint32_t root : senderRoots) level.push_back({root, receivers.root()});

  std::vector<double> first(level.size(), 0.0);
  std::vector<std::uint64_t> rays(level.size(), 0);
  parallelFor(level.size(), 1, [&](std::size_t i) {
    first[i] = judge.look(level[i], judge.key(level[i], settings.seed), kFirstLooks, rays[i]).flux;
  });
  double total = settings.otherFlux;
  for (std::size_t i = 0; i < level.size(); ++i) total += first[i], links.rays += rays[i];
  // In steps, so that a small edit, which moves all sums a little, does not refine other links than before.
  const double threshold = settings.share * coarse(total);

  while (!level.empty()) {
    struct Verdict {
      DsLink link;
      bool split = false;
    };
    constexpr std::size_t kBlock = 64;
    std::vector<Verdict> verdicts(level.size());
    rays.assign((level.size() + kBlock - 1) / kBlock, 0);
    parallelFor(level.size(), kBlock, [&](std::size_t i) {
      Verdict& v = verdicts[i];
      v.link.ends = level[i];
      v.link.key = judge.key(level[i], settings.seed);
      // Nothing passes, as long as neither end moves.
      if (emission.averted(level[i])) {
        v.link.flux = static_cast<float>(kLeast * threshold);
        return;
      }
      Judgement j = judge.look(level[i], v.link.key, kLooks, rays[i / kBlock]);
      const bool near = judge.near(level[i]), divisible = judge.divisible(level[i]);
      const auto splits = [&] {
        return divisible && j.flux > threshold && (near || (j.uneven && j.flux > kMuch * threshold));
      };
      v.split = splits();
      // Of ends close to each other few pairs of places may carry most.
      if (!v.split && near && divisible) {
        j = judge.look(level[i], ~v.link.key, kNearLooks, rays[i / kBlock]);
        v.split = splits();
      }
      // Most links of which nothing was seen to arrive are blocked: hope is worth a closer look before it gets
      // particles. The more it might carry, the closer.
      if (!v.split && (!j.arrived || j.bound > kLooks * threshold)) {
        const int looks = static_cast<int>(std::clamp(j.bound / threshold, double(kLooks), kMostLooks));
        j = judge.look(level[i], mix64(v.link.key), looks, rays[i / kBlock]);
        v.split = splits();
      }
      if (v.split) return;
      v.link.flux = static_cast<float>(std::max(j.flux, kLeast * threshold));
      v.link.passing = static_cast<float>(j.passing);
    });
    for (const std::uint64_t r : rays) links.rays += r;
    links.judged += level.size();
    std::vector<LinkEnds> next;
    for (const Verdict& v : verdicts) {
      if (!v.split) {
        if (v.link.flux > 0) links.all.push_back(v.link);
        continue;
      }
      const LinkEnds& e = v.link.ends;
      const bool sender = judge.splitsSender(e);
      const RadixNode& node = sender ? senders.nodes()[e.sender] : receivers.nodes()[e.receiver];
      for (const std::uint32_t child : node.child)
        next.push_back(sender ? LinkEnds{child, e.receiver} : LinkEnds{e.sender, child});
    }
    level = std::move(next);
  }
  std::sort(links.all.begin(), links.all.end(), [](const DsLink& a, const DsLink& b) { return a.key < b.key; });
  for (const DsLink& l : links.all) links.flux += l.flux;
  return links;
}

}  // namespace deltalux
