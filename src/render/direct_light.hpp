#pragma once
// Direct light at a point, measured with shadow rays: senders are picked in proportion to what they are expected to
// give (direct_senders.hpp), by systematic sampling, so that each gets its share of the rays to within one; then a
// point of the sender is sampled: small and whole lights as light_sampling.hpp does, parts of large ones by area, cells
// of the sky by solid angle. Panes attenuate. Unbiased wherever the links do not prove that no light comes. Cost: one
// shadow ray a sample.
#include <deltalux/probe.hpp>

#include "render/direct_senders.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct Solution;

/// Senders of one place with their summed shares.
struct SenderChoice {
  std::vector<ExpectedSender> senders;
  std::vector<float> cumulative;

  float total() const { return cumulative.empty() ? 0.0f : cumulative.back(); }
};

/// A point with the unit normal of the side that light falls on.
struct Receiver {
  Vec3 position, normal;
};

/// What one shadow ray found: unit direction towards the light, and the irradiance of a plane that faces it, divided by
/// the density of the sample.
struct LightArrival {
  Vec3 direction;
  LightId light;
  Rgb E;
};

class DirectLight {
 public:
  /// The solution must outlive this.
  explicit DirectLight(const Solution&);

  const LightSampler& lights() const { return lights_; }
  /// Senders of a leaf patch.
  SenderChoice choiceAt(ElementId leaf) const;
  /// Senders of a free point: all lights.
  SenderChoice choiceAt(const Receiver&) const;

  /// visit(LightArrival) for each of `rays` shadow rays that is not blocked: the sum of all of them is the estimate.
  /// `index` and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(const SenderChoice& choice, const Receiver& x, int rays, std::uint32_t index, std::uint64_t key,
              const Visit& visit) const {
    for (int k = 0; k < rays && choice.total() > 0; ++k)
      if (const auto ray = shadowRay(choice, x, k, rays, index, key)) visit(*ray);
  }
  /// The mean of `rays` samples as irradiance.
  Rgb irradiance(const SenderChoice&, const Receiver&, int rays, std::uint32_t index, std::uint64_t key) const;
  /// Irradiance to a relative standard error of `error` of itself plus `ambient`.
  ProbeResult measure(const SenderChoice&, const Receiver&, const Rgb& ambient, double error, int maxSamples,
                      std::uint64_t key) const;

 private:
  /// A point of a sender: unit direction, distance (infinite for distant ones), normal there, and what arrives at a
  /// plane facing it, over the density.
  struct SenderSample {
    ElementId sender;
    Vec3 direction;
    double distance;
    Vec3 normal;
    Rgb E;
  };
  std::optional<LightArrival> shadowRay(const SenderChoice&, const Receiver&, int k, int rays, std::uint32_t index,
                                        std::uint64_t key) const;
  std::optional<SenderSample> sampleSender(ElementId, const Receiver&, Vec2 u) const;
  bool ownSide(ElementId, const Vec3& y, const Vec3& normal) const;
  std::optional<SenderSample> samplePart(ElementId, const Receiver&, const Vec2& u) const;
  /// A light of a cluster of lights, and the chance that it was picked; `u` is used up in part.
  ElementId pickLight(ElementId, const Vec3f& x, double& u, float& chance) const;

  const Scene& scene_;
  const Elements& elements_;
  const RayTracer& tracer_;
  LightSampler lights_;
  DirectSenders senders_;
};

}  // namespace deltalux
