#include "paper/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace deltalux::paper {

namespace {

/// Of rays of which these shares of light pass.
VisibilityEstimate estimate(std::span<const LinkSample> samples, const Rgb* through, bool clusterReceiver) {
  VisibilityEstimate result;
  RgbSum passed(0.0);
  double weights = 0, squares = 0, clearWeight = 0;
  std::array<double, 4> quadrantClear{}, quadrantWeight{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double weight = samples[i].weight;
    const std::size_t quadrant = samples[i].quadrant;
    if (!(weight > 0)) continue;
    const double seen = maxChannel(through[i]) > 0 ? weight : 0.0;
    if (seen > 0) result.mask |= 1u << i;
    passed += weight * RgbSum(through[i]);
    weights += weight;
    squares += weight * weight;
    // Where on the receiver the sample lies tells how visibility varies over it.
    clearWeight += seen;
    quadrantClear[quadrant] += seen;
    quadrantWeight[quadrant] += weight;
  }
  result.samples = static_cast<std::uint8_t>(samples.size());
  if (weights <= 0) {
    // No sampled pair faced each other: nothing is known.
    result.V = Rgb(1.0f);
    result.spread = 1.0f;
    return result;
  }
  result.V = Rgb(passed / weights);
  const double clear = clearWeight / weights;
  const double effective = weights * weights / squares;
  if (clear > 0 && clear < 1) {
    // The surfaces of a cluster are lit or not one by one: the mean over them speaks for none.
    double spread = std::sqrt(clear * (1 - clear) / (clusterReceiver ? 1.0 : effective));
    for (std::size_t q = 0; q < 4; ++q)
      if (quadrantWeight[q] > 0) spread = std::max(spread, std::abs(quadrantClear[q] / quadrantWeight[q] - clear));
    result.spread = static_cast<float>(spread);
  } else {
    // None of the rays disagrees: what they may have missed.
    result.spread = static_cast<float>(0.5 / (effective + 1));
  }
  return result;
}

}  // namespace

VisibilitySamples::VisibilitySamples(const hierarchy::Elements& elements, const Scene& scene,
                                     const tracing::RayTracer& tracer, hierarchy::ElementId receiver,
                                     hierarchy::ElementId sender)
    : samples_(elements, scene, receiver, sender), tracer_(tracer), clusterReceiver_(elements.isCluster(receiver)) {}

Rgb VisibilitySamples::pass(std::size_t i) {
  if (!(sample_[i].weight > 0)) return Rgb(0.0f);
  ++traced_;
  return tracer_.transmittance(sample_[i].ray);
}

VisibilityEstimate VisibilitySamples::known() const {
  return paper::estimate({sample_.data(), taken_}, through_.data(), clusterReceiver_);
}

VisibilityEstimate VisibilitySamples::estimate(std::size_t count) {
  for (; taken_ < count; ++taken_)
    sample_[taken_] = samples_[static_cast<int>(taken_)], through_[taken_] = pass(taken_);
  return known();
}

VisibilityEstimate VisibilitySamples::renewed(const hierarchy::Link& link, std::uint32_t anew) {
  const VisibilityEstimate before{link.V, link.visibilitySpread, link.sampleMask, link.samples};
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < link.samples; ++i)
      if (anew >> i & 1u) visit(i);
  };
  bool same = isBlack(link.V);
  if (same)
    each([&](std::size_t i) {
      sample_[i] = samples_[static_cast<int>(i)], through_[i] = pass(i), same = same && isBlack(through_[i]);
    });
  if (same) return before;
  for (; taken_ < link.samples; ++taken_) {
    if (isBlack(link.V) && anew >> taken_ & 1u) continue;
    sample_[taken_] = samples_[static_cast<int>(taken_)];
    through_[taken_] = Rgb(link.sampleMask >> taken_ & 1u ? 1.0f : 0.0f);
  }
  if (isBlack(link.V)) return known();
  if (known().V != link.V) anew = ~0u;  // tinted by glass: the mask does not say what passed
  each([&](std::size_t i) { through_[i] = pass(i); });
  return known();
}

}  // namespace deltalux::paper
