#pragma once
// Visibility of a link by stratified rays between points of its ends (link_samples.hpp).
#include "hierarchy/link.hpp"
#include "paper/link_samples.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

inline constexpr std::size_t kMaxSamples = 32;  // [layout]

struct VisibilityEstimate {
  Rgb V{0.0f};
  float spread = 0;  // bound on |V(x) - V| over the receiver
  std::uint32_t mask = 0;
  std::uint8_t samples = 0;
};

/// The samples of one link as they are taken, a few at first.
class VisibilitySamples {
 public:
  /// All must outlive this.
  VisibilitySamples(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&, hierarchy::ElementId receiver,
                    hierarchy::ElementId sender);

  /// What the first `count` rays tell, in 1..kMaxSamples; those are traced that have not been.
  VisibilityEstimate estimate(std::size_t count);
  /// What those of `link` tell when only some of them may fare otherwise by now: `anew`, by bits.
  VisibilityEstimate renewed(const hierarchy::Link& link, std::uint32_t anew);
  int traced() const { return traced_; }

 private:
  Rgb pass(std::size_t sample);
  VisibilityEstimate known() const;

  LinkSamples samples_;
  const tracing::RayTracer& tracer_;
  bool clusterReceiver_;
  std::size_t taken_ = 0;
  int traced_ = 0;
  std::array<LinkSample, kMaxSamples> sample_;
  std::array<Rgb, kMaxSamples> through_;
};

}  // namespace deltalux::paper
