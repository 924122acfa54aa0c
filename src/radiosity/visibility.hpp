#pragma once
// Visibility of a link by stratified rays between points of its ends, weighted by the kernel. Points of clusters are
// points of their surfaces, so that what a cluster hides of itself counts. The samples depend on the link's stable key
// alone, and more samples extend the same sequence.
#include "hierarchy/link.hpp"
#include "radiosity/space_change.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

inline constexpr int kMaxSamples = 32;
inline constexpr int kFewSamples = 4;  // of links that bring little, or are split for their kernel

struct VisibilityEstimate {
  Rgb V{0.0f};
  float spread = 0;  // bound on |V(x) - V| over the receiver
  std::uint32_t mask = 0;
  std::uint8_t samples = 0;
};

/// `samples` in 1..kMaxSamples rays.
VisibilityEstimate sampleVisibility(const Elements&, const Scene&, const RayTracer&, ElementId receiver,
                                    ElementId sender, int samples);

/// The link's samples as they are after a move: only those rays are traced that meet what has moved. `rays` counts
/// them.
VisibilityEstimate resampleVisibility(const Elements&, const Scene&, const RayTracer&, const Link&, const SpaceChange&,
                                      int& rays);

/// Chance that light passes a link, as its rays leave it: where none passed it may still be open. 1: it surely passes.
float openness(const Link&);

/// Whether a ray that the link's visibility was sampled by may fare otherwise after a move: one that passed meets what
/// moves where it is or will be; one that did not, where it is: nothing that comes lets it pass.
bool samplesMeet(const Elements&, const Scene&, const Link&, const SpaceChange& all, const SpaceChange& before);

}  // namespace deltalux
