#include "particles/ds_links.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "particles/flux_estimate.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

namespace {

/// What the pilots at a link are for: whether it is to be refined, and which end.
class Evaluator {
 public:
  Evaluator(const Senders& senders, const Receivers& receivers) : senders_(senders), receivers_(receivers) {}

  bool near(const LinkEnds& ends) const {
    const BoundingSphere &s = senders_.bound(ends.sender), &r = receivers_.bound(ends.receiver);
    const SenderKind kind = kindOf(ends.sender);
    if (kind == SenderKind::Sun) return false;
    if (kind == SenderKind::Sky) return s.radius * deltalux::tuning::kFar > 1;
    return (s.radius + r.radius) * deltalux::tuning::kFar > glm::distance(s.center, r.center);
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

  const Senders& senders_;
  const Receivers& receivers_;
};

struct Evaluation {
  DsLink link;
  bool split = false;
};

/// PilotSamples at a link until it is clear whether it is to be refined, and about what passes.
Evaluation evaluated(const LinkEnds& ends, std::uint64_t key, double threshold, const Evaluator& evaluator,
                     const FluxEstimate& estimate, FluxEstimate::Workspace& workspace) {
  Evaluation v;
  v.link.ends = ends, v.link.key = key;
  const bool near = evaluator.near(ends), divisible = evaluator.divisible(ends);
  const double most = estimate.most(ends);
  PilotSamples pilots;
  const auto splits = [&] {
    const double flux = pilots.flux(most);
    return divisible && flux > threshold && (near || (pilots.uneven() && flux > tuning::kMuch * threshold));
  };
  estimate.sample(ends, key, deltalux::tuning::kPilots, pilots, workspace);
  v.split = splits();
  // Of ends close to each other few pairs of places may carry most.
  if (!v.split && near && divisible && most > threshold) {
    estimate.sample(ends, key, deltalux::tuning::kPilots, pilots, workspace);
    v.split = splits();
  }
  // Most links of which nothing was seen to arrive are blocked: hope is worth a closer look before it gets particles.
  // The more it might carry, the closer.
  const double bound = std::min(pilots.bound(), most);
  if (!v.split && (!pilots.arrived() || bound > deltalux::tuning::kPilots * threshold)) {
    const int enough =
        static_cast<int>(std::clamp(bound / threshold, double(deltalux::tuning::kPilots), double(kMostLooks)));
    estimate.sample(ends, key, enough, pilots, workspace);
    v.split = splits();
  }
  v.link.flux = static_cast<float>(std::max(pilots.flux(most), deltalux::tuning::kNegligible * threshold));
  v.link.passing = static_cast<float>(pilots.passing());
  return v;
}

}  // namespace

DsLinks refineDsLinks(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission,
                      const Senders& senders, const Receivers& receivers, const CoarseExitance& exitance,
                      std::span<const std::uint32_t> senderRoots, const DsSettings& settings) {
  DsLinks links;
  if (receivers.empty()) return links;
  const Evaluator evaluator(senders, receivers);
  const FluxEstimate estimate(scene, tracer, emission, senders, receivers, exitance);
  std::vector<LinkEnds> level;
  for (const std::uint32_t root : senderRoots) level.push_back({root, receivers.root()});

  std::vector<double> first(level.size(), 0.0);
  std::vector<std::uint64_t> rays(level.size(), 0);
  parallelFor(level.size(), 1, [&](std::size_t i) {
    FluxEstimate::Workspace workspace;
    PilotSamples pilots;
    estimate.sample(level[i], evaluator.key(level[i], settings.seed), kMostLooks, pilots, workspace);
    first[i] = pilots.flux(estimate.most(level[i])), rays[i] = workspace.traced;
  });
  double total = settings.otherFlux;
  for (std::size_t i = 0; i < level.size(); ++i) total += first[i], links.rays += rays[i];
  // In steps, so that a small edit, which moves all sums a little, does not refine other links than before.
  const double threshold = settings.share * coarse(total);
  if (!(threshold > 0)) return links;  // there is no light

  while (!level.empty()) {
    constexpr std::size_t kBlock = 64;  // [task]
    std::vector<Evaluation> evaluations(level.size());
    rays.assign((level.size() + kBlock - 1) / kBlock, 0);
    parallelBlocks(level.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      FluxEstimate::Workspace workspace;
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint64_t key = evaluator.key(level[i], settings.seed);
        // Averted: nothing passes, as long as neither end moves.
        evaluations[i] =
            emission.averted(level[i])
                ? Evaluation{{level[i], key, static_cast<float>(deltalux::tuning::kNegligible * threshold), 0}, false}
                : evaluated(level[i], key, threshold, evaluator, estimate, workspace);
        evaluations[i].link.albedo =
            static_cast<float>(std::max<double>(estimate.albedo(level[i]), deltalux::tuning::kNegligible));
      }
      rays[begin / kBlock] = workspace.traced;
    });
    for (const std::uint64_t r : rays) links.rays += r;
    links.evaluated += level.size();
    std::vector<LinkEnds> next;
    for (const Evaluation& v : evaluations) {
      if (!v.split) {
        if (v.link.flux > 0) links.all.push_back(v.link);
        continue;
      }
      const LinkEnds& e = v.link.ends;
      const bool sender = evaluator.splitsSender(e);
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

}  // namespace deltalux::particles
