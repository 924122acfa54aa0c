#pragma once
// What arrives at one place from other surfaces, resolved to the leaf patches that send it. A link says what its whole
// receiver gets from its whole sender; here rays are shared among the links that cover the place in proportion to what
// they may bring, and each finds its way down from its link's sender to one leaf, by the same measure at every level.
// So what a sender hides of itself where it is bright, and what stands just here, is seen without finer links (final
// gathering [Reichert 1992; LTG93], with the links as its importance function).
//
//   E = sum over rays T B(leaf),   T = K V / (n p)              flat leaves
//                                  T = A w V / (n p)            curved ones
//
// with p the chance of the leaf, K its exact kernel, w the kernel between two points, V whether the ray passes. One
// stratified number deals the rays out over all links (systematic sampling), so that a closed room's row sums to one
// but for what V leaves to chance. Flat senders that the links prove clear take K and no ray, in parts so small that
// their radiosity counts as even. Everything that may send has a chance, also what is dark at present. Samples depend
// on the keys of place and sender. Cost: about 15 kernels' time a link, one ray and some 15 kernels a sample.
#include <array>
#include <span>
#include <vector>

#include "hierarchy/link.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/exposure.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

/// E += T * B(leaf).
struct LeafTransfer {
  ElementId leaf;
  Rgb T{0.0f};
};

class IndirectSampler {
 public:
  /// All must outlive this.
  IndirectSampler(const Scene&, const Elements&, const Links&, const RayTracer&);

  /// Appends the transfers to a leaf patch as a whole, by at most `rays` rays. Returns the rays traced.
  std::size_t atLeaf(ElementId leaf, int rays, std::vector<LeafTransfer>& out) const;
  /// Irradiance at a point of a leaf patch (unit normal) from the leaves' radiosities.
  Rgb atPoint(ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const;

 private:
  struct Term {
    ElementId sender;
    float K;
    float open;    // chance that light passes
    float weight;  // what it may bring, gray
  };
  template <class KernelOf>
  Term term(ElementId leaf, ElementId sender, float open, const KernelOf&) const;
  /// The senders that cover all of what the leaf sees, fine enough for `rays` rays.
  template <class KernelOf>
  std::vector<Term> terms(ElementId leaf, int rays, const KernelOf&) const;
  float guess(ElementId leaf, const PatchPoint& x, ElementId part) const;
  /// The leaf below a sender that the number `u` picks, in proportion to what each may bring to `x`; `u` is used up in
  /// part, `chance` multiplied by that of the leaf.
  ElementId descend(ElementId sender, ElementId leaf, const PatchPoint& x, double& u, double& chance) const;
  template <class KernelOf, class PointAt, class Visit>
  std::size_t sample(ElementId leaf, const PatchPoint& center, int rays, const KernelOf&, const PointAt&,
                     const Visit&) const;
  template <class PointAt, class Visit>
  std::size_t sampleLeaf(const Term&, float gain, std::uint64_t key, std::array<double, 4> u, const PointAt&,
                         const Visit&) const;
  bool exact(ElementId sender) const;
  /// Whether a term needs no ray.
  bool known(const Term& t) const { return t.open >= 1.0f && exact(t.sender); }
  float strength(ElementId receiver, ElementId sender) const;

  const Scene& scene_;
  const Elements& elements_;
  const RayTracer& tracer_;
  Exposure exposure_;
  const Links& links_;
};

}  // namespace deltalux
