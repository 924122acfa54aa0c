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
// five kernels a light, about `rays` rays. After a move only lights are sampled anew whose links are others
// (direct_update.cpp).
#include <array>
#include <span>

#include "base/random.hpp"
#include "paper/space_change.hpp"
#include "radiosity/direct_senders.hpp"
#include "radiosity/exposure.hpp"
#include "radiosity/leaf_row.hpp"
#include "radiosity/ray_shares.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::radiosity {

/// The row of one leaf.
struct DirectRow {
  TransferRow row;                          // emitters in place of leaves; over the whole leaf
  double mean = 0;                          // irradiance, gray
  double variation = 0;                     // of it over the quadrants, beyond what chance explains
  std::uint8_t darkest = 0, brightest = 0;  // quadrants
  float exposed = 1;                        // share of the leaf's area that this is the mean of (exposure.hpp)
  std::uint64_t rays = 0;
};

/// What a move has done to the direct row of a leaf.
struct DirectUpdate {
  bool anew = false;     // nothing was done: the row must be sampled anew
  bool any = false;      // terms were
  double change = 0;     // of irradiance, gray, each term's counted positive, where rays met what moved
  double variation = 0;  // over the quadrants, of what lights bring whose links are others
};

class DirectSampler {
 public:
  /// All must outlive this.
  DirectSampler(const Scene&, const hierarchy::Elements&, const hierarchy::Links&, const tracing::RayTracer&);

  /// By about `rays` shadow rays.
  DirectRow at(hierarchy::ElementId leaf, int rays) const;
  /// Traces those terms of the leaf's row again whose rays meet what has moved, and samples lights anew whose links are
  /// others by now; rays are dealt to them as the row has dealt them, `rays` in all. `changed`: the topmost changed
  /// links of lights that arrive at the leaf or above it.
  DirectUpdate update(hierarchy::ElementId leaf, int rays, const paper::LinkChanges&,
                      std::span<const hierarchy::LinkId> changed, const paper::SpaceChange&, TransferRow&,
                      std::uint64_t& traced) const;

 private:
  static constexpr int kFacingTries = 8;  // more points of a light when some face away
  struct Term {
    hierarchy::LinkId link;
    hierarchy::ElementId sender;
    bool curved = false, clear = false, seen = false;
    float K = 0;
    std::array<float, 4> at{};  // K at the leaf's nodes
    float open = 0, weight = 0;

    bool known() const { return clear && !curved; }  // takes no ray
  };
  /// What the shadow rays of a light find.
  struct Passage {
    Rgb T{0.0f};
    double weights = 0;
    std::array<double, 4> seen{}, all{};  // by quadrant of the leaf
    std::array<int, 4> count{};
    int used = 0;
    RowReach reach;  // of the rays
  };
  /// Lights of too few rays to tell quadrants apart, cells of the sky above all: together they do.
  struct Pool {
    std::array<double, 4> whole{};        // irradiance, were nothing in the way, by quadrant
    std::array<double, 4> all{}, seen{};  // of rays that start there: weights, and what passed
    std::array<double, 4> square{};       // their weights squared
  };
  /// A row in the making: irradiance by quadrant, and the variance that chance gives it.
  struct Sampled {
    Pool pool;
    TransferRow row;
    std::array<double, 4> E{}, chance{};
    std::uint64_t rays = 0;
  };
  /// One shadow ray. A light that is sampled by solid angle brings its radiance, as it was read, times cosine over
  /// density.
  struct Shot {
    tracing::Ray ray;
    double weight = 0;  // not above 0: light and place do not face each other
    Rgb radiance{0.0f};
    std::size_t quadrant = 0;
  };

  std::vector<Term> terms(hierarchy::ElementId leaf, const std::vector<PossibleSender>&) const;
  Term term(hierarchy::ElementId leaf, const PossibleSender&) const;
  void setKernel(hierarchy::ElementId leaf, Term&) const;
  std::uint64_t rayKey(hierarchy::ElementId leaf, hierarchy::ElementId sender) const;
  bool curved(hierarchy::ElementId sender) const;
  bool sampledByAngle(hierarchy::ElementId sender) const;
  Rgb wholeB(hierarchy::ElementId sender) const;
  Vec3f endOf(const tracing::Ray&) const;
  void remember(hierarchy::ElementId sender, const Passage&, TransferRow&) const;
  Shot shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, std::uint64_t key, int i) const;
  bool meets(hierarchy::ElementId leaf, const RowTerm&, const paper::SpaceChange&) const;
  std::vector<std::uint32_t> meeting(hierarchy::ElementId leaf, const paper::LinkChanges&, const paper::SpaceChange&,
                                     const TransferRow&) const;
  Passage pass(hierarchy::ElementId leaf, const Term&, int rays, std::uint64_t key, std::uint64_t& traced) const;
  /// Deals rays out over terms, one for `step` of weight; over those that are worth less than one by halves
  /// (ray_shares.hpp), as many to each half as it is worth: of the sky, of which leaves see hundreds of cells, no part
  /// is met too often or too seldom by chance.
  void deal(hierarchy::ElementId leaf, const std::vector<Term>&, float step, Sampled&) const;
  void sample(hierarchy::ElementId leaf, const Term&, int rays, float gain, Sampled&) const;
  void dealFew(hierarchy::ElementId leaf, const std::vector<Term>&, float step, Sampled&) const;
  std::uint64_t placeOf(hierarchy::ElementId sender) const;
  void addPool(Sampled&) const;
  double mean(hierarchy::ElementId leaf, const Sampled&) const;
  double variation(hierarchy::ElementId leaf, const Sampled&) const;
  Passage tracedAgain(hierarchy::ElementId leaf, const RowTerm&, std::uint64_t& traced) const;
  bool sampleChanged(hierarchy::ElementId leaf, int rays, std::span<const hierarchy::LinkId> changed, float gone,
                     TransferRow&, DirectUpdate&, std::uint64_t& traced) const;
  bool dealtOver(const paper::LinkChanges&, std::span<const hierarchy::LinkId> changed, const paper::SpaceChange&,
                 const RowTerm&) const;

  const Scene& scene_;
  const hierarchy::Elements& elements_;
  const hierarchy::Links& links_;
  const tracing::RayTracer& tracer_;
  Exposure exposure_;
  DirectSenders senders_;
  scene::LightSampler lights_;
  PlaceCodes places_;
};

}  // namespace deltalux::radiosity
