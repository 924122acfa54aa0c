#pragma once
// What lights bring a leaf patch: for every light that the links let reach it, the transfer K, exact where the light is
// flat, times the share of shadow rays that pass; so a light in plain view has no noise, a light half hidden only that
// of its rays.
//
//   E = sum over lights T B(light),   T = K sum_i w_i V_i / sum_i w_i    points, flat lights, cells of the sky, the sun
//                                     T = sum_i cos_i L_i V_i / (n p_i B)    curved ones, by solid angle
//
// Rays go where light may come from, as for indirect light; what no ray of the links saw takes no more of them than
// what was seen. The four quadrants of the leaf are kept apart: how much they differ says whether to split it. Cost:
// five kernels a light, about `rays` rays.
#include "base/random.hpp"
#include "radiosity/direct_senders.hpp"
#include "radiosity/exposure.hpp"
#include "radiosity/leaf_row.hpp"
#include "radiosity/space_change.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

/// The row of one leaf.
struct DirectRow {
  TransferRow row;       // emitters in place of leaves; over the whole leaf
  double mean = 0;       // irradiance, gray
  double variation = 0;  // of it over the quadrants, beyond what chance explains
  float exposed = 1;     // share of the leaf's area that this is the mean of (exposure.hpp)
  std::uint64_t rays = 0;
};

/// What a move has done to the direct row of a leaf.
struct DirectUpdate {
  bool anew = false;  // nothing was done: a link is another, or a light moved; the row must be sampled anew
  bool any = false;   // terms were
  double change = 0;  // of irradiance, gray, each term's counted positive
};

class DirectSampler {
 public:
  /// All must outlive this.
  DirectSampler(const Scene&, const Elements&, const Links&, const RayTracer&);

  /// By about `rays` shadow rays.
  DirectRow at(ElementId leaf, int rays) const;
  /// Traces those terms of the leaf's row again whose rays meet what has moved.
  DirectUpdate update(ElementId leaf, const LinkChanges&, const SpaceChange&, TransferRow&,
                      std::uint64_t& traced) const;

 private:
  struct Term;
  struct Quadrants;
  Term term(ElementId leaf, const PossibleSender&) const;
  void setKernel(ElementId leaf, Term&) const;
  std::uint64_t rayKey(ElementId leaf, ElementId sender) const;
  struct Shot;
  struct Passage;
  bool curved(ElementId sender) const;
  bool sampledByAngle(ElementId sender) const;
  Shot shoot(ElementId leaf, ElementId sender, std::uint64_t key, int i) const;
  bool meets(ElementId leaf, const RowTerm&, const SpaceChange&) const;
  Passage pass(ElementId leaf, const Term&, int rays, std::uint64_t key, std::uint64_t& traced) const;
  void sample(ElementId leaf, const Term&, int rays, float gain, std::uint64_t key, DirectRow&, Quadrants&) const;

  const Scene& scene_;
  const Elements& elements_;
  const RayTracer& tracer_;
  Exposure exposure_;
  DirectSenders senders_;
  LightSampler lights_;
};

}  // namespace deltalux
