#pragma once
// What arrives at one place from other surfaces, resolved to the leaf patches that send it. A link says what its whole
// receiver gets from its whole sender; here each link that covers the place is sampled: rays from points of the place
// to points of the sender, in proportion to what the link may bring, each ray telling whether its leaf is seen. So what
// a sender hides of itself where it is bright, and what stands just here, is seen without finer links (final gathering
// [Reichert 1992; LTG93], with the links as its importance function).
//
//   E = sum over links sum over rays T_i B(leaf_i),   T_i = K w_i V_i / sum_j w_j    flat senders
//                                                     T_i = A w_i V_i / n            clusters and curved ones
//
// with K exact for the flat polygon, w the kernel between two points. Links whose share is less than a ray are sampled
// by chance and weighted up, so nothing is left out. Samples depend on the keys of place and sender, not on the order
// of links. Cost: about 15 kernels' time a link, one ray a sample.
#include <span>
#include <vector>

#include "hierarchy/link.hpp"
#include "hierarchy/patch.hpp"
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

  /// Appends the transfers to a leaf patch as a whole, by about `rays` rays. Returns the rays traced.
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
  template <class PointAt, class Visit>
  std::size_t sample(const std::vector<Term>&, int rays, std::uint64_t key, const PointAt&, const Visit&) const;
  template <class PointAt, class Visit>
  std::size_t sampleTerm(const Term&, int rays, float gain, std::uint64_t key, const PointAt&, const Visit&) const;
  bool exact(ElementId sender) const;
  float strength(ElementId receiver, ElementId sender) const;

  const Scene& scene_;
  const Elements& elements_;
  const RayTracer& tracer_;
  const Links& links_;
};

}  // namespace deltalux
