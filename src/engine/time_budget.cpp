#include "engine/time_budget.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "radiosity/direct_sampler.hpp"
#include "radiosity/indirect_sampler.hpp"

namespace deltalux::engine {

namespace {

constexpr double kStep = 0.84;         // between errors that are considered
constexpr double kSplitting = 1.4;     // leaves of the last round, and its settling, against leaves before it
constexpr std::size_t kSampled = 128;  // leaves that are timed
constexpr double kFewestRays = 0.125;  // share of the leaves' rays that is always kept

}  // namespace

void TimeBudget::learn(double seconds, double predicted, double made) {
  if (made > 0) secondsPerLink_ = seconds / made;
  if (predicted > 0) trust_ = std::clamp(made / predicted, 0.05, 20.0);
}

double TimeBudget::reach(const paper::LinkErrors& errors, double from, double least, double seconds) const {
  double error = from;
  while (error > least) {
    const double next = std::max(least, error * kStep);
    if (cost(errors.madeBy(next)) > seconds) break;
    error = next;
  }
  return error;
}

double leafRoundSeconds(const hierarchy::Elements& elements, const hierarchy::Links& links, const Scene& scene,
                        const tracing::RayTracer& tracer, const radiosity::LeafTransferSettings& settings) {
  std::vector<hierarchy::ElementId> leaves;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements.isReceivingLeaf(hierarchy::ElementId(i))) leaves.push_back(hierarchy::ElementId(i));
  }
  if (leaves.empty()) return 0;
  const radiosity::DirectSampler direct(scene, elements, links, tracer);
  const radiosity::IndirectSampler indirect(scene, elements, links, tracer);
  const radiosity::GatherRays gatherRays(settings, leaves.size(), radiosity::meanOf(leaves, elements));
  const std::size_t n = std::min(kSampled, leaves.size());
  const auto start = std::chrono::steady_clock::now();
  parallelFor(n, 4, [&](std::size_t i) {
    const hierarchy::ElementId leaf = leaves[i * leaves.size() / n];
    direct.at(leaf, settings.shadowRays);
    std::uint64_t traced = 0;
    indirect.atLeaf(leaf, gatherRays.of(leaf, elements), traced);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return kSplitting * seconds * static_cast<double>(leaves.size()) / static_cast<double>(n);
}

radiosity::LeafTransferSettings shrunk(radiosity::LeafTransferSettings settings, double needed, double seconds) {
  if (needed <= seconds) return settings;
  const double share = std::max(kFewestRays, seconds / needed);
  settings.shadowRays = static_cast<int>(settings.shadowRays * share);
  settings.gatherRays = static_cast<int>(settings.gatherRays * share);
  settings.inAll = static_cast<int>(settings.inAll * share);
  settings.variation = std::numeric_limits<double>::infinity();
  return settings;
}

}  // namespace deltalux::engine
