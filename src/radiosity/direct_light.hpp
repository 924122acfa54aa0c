#pragma once
// Direct light at a point, measured with shadow rays. For each leaf patch, a few test rays to every sender that the
// links name (direct_senders.hpp) tell which of them are seen from there. Rays then go to those in proportion to the
// spread of what one of them gives, by systematic sampling, so that each gets its share to within one; a quarter of the
// rays go to senders that no test ray saw: a patch that the sun touches at one corner finds it, and one that it does
// not touch loses few rays to it. A point of the sender is sampled: small and whole lights as light_sampling.hpp does,
// parts of large ones by area, cells of the sky by solid angle. Panes attenuate. Unbiased wherever the links do not
// prove that no light comes. Cost: one shadow ray a sample; 4 to 16 test rays a sender for each leaf that is looked at.
#include <deltalux/probe.hpp>

#include "base/random.hpp"
#include "radiosity/direct_senders.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::radiosity {

/// Senders with their shares of the rays, summed.
struct SenderList {
  std::vector<hierarchy::ElementId> senders;
  std::vector<float> cumulative;

  float total() const { return cumulative.empty() ? 0.0f : cumulative.back(); }
  void add(hierarchy::ElementId sender, float share) {
    senders.push_back(sender);
    cumulative.push_back(total() + share);
  }
};

/// The senders of one place.
struct SenderChoice {
  SenderList seen, unseen;  // by test rays

  bool dark() const { return !(seen.total() > 0 || unseen.total() > 0); }
};

/// Test rays of a place: shared by potential, within bounds for one sender.
struct TestRays {
  float all = 256;
  int fewest = 4, most = 16;
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
  /// All must outlive this.
  DirectLight(const Scene&, const hierarchy::Elements&, const hierarchy::Links&, const tracing::RayTracer&);

  const scene::LightSampler& lights() const { return lights_; }
  /// Senders of a leaf patch, as seen from points all over it by `tests` rays, shared by what senders may bring.
  SenderChoice choiceAt(hierarchy::ElementId leaf, const TestRays& tests = {}) const;
  /// Senders of a free point, out of all lights.
  SenderChoice choiceAt(const Receiver&) const;

  /// What a shadow ray finds of one sender by the numbers `u` in [0,1)^2, uniform ones; nullopt when it is blocked.
  std::optional<LightArrival> arrival(hierarchy::ElementId sender, const Receiver&, const Vec2& u) const;
  /// visit(LightArrival) for each of `rays` shadow rays (at least 2) that is not blocked: the sum of all of them is the
  /// estimate. `index` and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(const SenderChoice& choice, const Receiver& x, int rays, std::uint32_t index, std::uint64_t key,
              const Visit& visit) const {
    const int doubts = raysToUnseen(choice, rays);
    for (int k = 0; k < rays; ++k) {
      const auto arrival = k < doubts ? shadowRay(choice.unseen, x, k, doubts, index, combineKeys(key, 3))
                                      : shadowRay(choice.seen, x, k - doubts, rays - doubts, index, key);
      if (arrival) visit(*arrival);
    }
  }
  /// The sum of `rays` samples as irradiance.
  Rgb irradiance(const SenderChoice&, const Receiver&, int rays, std::uint32_t index, std::uint64_t key) const;
  /// Irradiance to a relative standard error of `error` of itself plus `ambient`.
  ProbeResult measure(const SenderChoice&, const Receiver&, const Rgb& ambient, double error, int maxSamples,
                      std::uint64_t key) const;

 private:
  /// A point of a sender: unit direction, distance (infinite for distant ones), normal there, and what arrives at a
  /// plane facing it, over the density.
  struct SenderSample {
    hierarchy::ElementId sender;
    Vec3 direction;
    double distance;
    Vec3 normal;
    Rgb E;
  };
  static int raysToUnseen(const SenderChoice&, int rays);
  std::optional<LightArrival> shadowRay(const SenderList&, const Receiver&, int k, int rays, std::uint32_t index,
                                        std::uint64_t key) const;
  struct Trial;
  template <class ReceiverAt>
  void test(Trial&, int tests, std::uint64_t key, const ReceiverAt& receiver) const;
  void promoteNeighbours(std::vector<Trial>&) const;
  /// Sorts senders by test rays from points that `receiver(i, key)` gives.
  template <class ReceiverAt>
  SenderChoice tested(const std::vector<PossibleSender>&, const TestRays&, std::uint64_t key,
                      const ReceiverAt& receiver) const;
  std::optional<SenderSample> sampleSender(hierarchy::ElementId, const Receiver&, Vec2 u) const;
  bool ownSide(hierarchy::ElementId, const Vec3& y, const Vec3& normal) const;
  std::optional<SenderSample> samplePart(hierarchy::ElementId, const Receiver&, const Vec2& u) const;
  /// A light of a cluster of lights, and the chance that it was picked; `u` is used up in part.
  hierarchy::ElementId pickLight(hierarchy::ElementId, const Vec3f& x, double& u, float& chance) const;

  const Scene& scene_;
  const hierarchy::Elements& elements_;
  const tracing::RayTracer& tracer_;
  scene::LightSampler lights_;
  DirectSenders senders_;
};

}  // namespace deltalux::radiosity
