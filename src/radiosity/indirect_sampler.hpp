#pragma once
// What arrives at one place from other surfaces, resolved to the leaf patches that send it. A link says what its whole
// receiver gets from its whole sender; here rays are shared among the links that cover the place in proportion to what
// they may bring, and each finds its way down from its link's sender to one leaf, by the same measure at every level.
// So what a sender hides of itself where it is bright, and what stands just here, is seen without finer links (final
// gathering [Reichert92; LTG93], with the links as its importance function).
//
//   E = sum over rays T B(leaf),   T = K V / (n p)              between flat leaves
//                                  T = A w V / (n p)            where one is curved, or covered in part
//
// with n p the expected rays of the leaf, K its exact kernel, w the kernel between two points, V whether the ray
// passes. Rays are dealt out by halves (ray_shares.hpp) over all links and down to leaves, so that a closed room's row
// sums to one but for what V leaves to chance, and a little more light somewhere moves few rays. Flat senders that the
// links prove clear take K and no ray, in parts so small that their radiosity counts as even. Everything that may send
// has a chance, also what is dark at present. A ray depends on the keys of place and leaf alone, so that it can be
// traced again. Cost: about 15 kernels' time a link, one ray and some 15 kernels a sample.
#include <array>
#include <span>
#include <vector>

#include "hierarchy/patch.hpp"
#include "paper/sender_sampling.hpp"
#include "paper/space_change.hpp"
#include "radiosity/close_pairs.hpp"
#include "radiosity/leaf_row.hpp"
#include "radiosity/ray_shares.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::radiosity {

class IndirectSampler {
 public:
  /// All must outlive this.
  IndirectSampler(const Scene&, const hierarchy::Elements&, const hierarchy::Links&, const tracing::RayTracer&);

  /// The transfers to a leaf patch as a whole, by at most `rays` rays. Adds the rays traced to `traced`.
  TransferRow atLeaf(hierarchy::ElementId leaf, int rays, std::uint64_t& traced) const;
  /// Makes those terms anew whose link is another by now, whose sender moved, or whose ray meets what moved; the others
  /// stay. `changed`: the topmost changed links that arrive at the leaf or above it; at most `rays` go over those.
  /// Returns whether the transfers are others then. The row of a leaf that moved is made anew by `rays` where too
  /// little of it is left, or its rays have grown too uneven.
  bool update(hierarchy::ElementId leaf, const paper::LinkChanges& links, std::span<const hierarchy::LinkId> changed,
              const paper::SpaceChange&, int rays, TransferRow&, std::uint64_t& traced) const;
  /// The row of a leaf that has been split off another, by the rays that were dealt to that one: each is drawn anew
  /// from this leaf, and those over changed links are dealt anew. A row of its own where the rays do not suit it.
  TransferRow inherited(hierarchy::ElementId leaf, const TransferRow& from, const paper::LinkChanges&,
                        std::span<const hierarchy::LinkId> changed, int rays, std::uint64_t& traced) const;
  /// Irradiance at a point of a leaf patch (unit normal) from the leaves' radiosities.
  Rgb atPoint(hierarchy::ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const;
  /// The same by who sends it: what its parts bring, in no order; their sum is atPoint().
  struct Share {
    hierarchy::ElementId sender;
    Rgb E{0.0f};
  };
  std::vector<Share> sharesAtPoint(hierarchy::ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const;

 private:
  /// visit(sender, E) of all that brings any.
  template <class Visit>
  void gatherAt(hierarchy::ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays, const Visit&) const;
  struct Term {
    hierarchy::LinkId link;
    hierarchy::ElementId sender;
    float K;
    float open;    // chance that light passes
    float weight;  // what it may bring, gray
  };
  /// One ray that the deal has given to a leaf, or a sender in plain view that needs none.
  struct Dealt {
    Term term;
    float gain = 1;
    int index = 0;  // of the ray, among those of its term
  };
  template <class KernelOf>
  Term term(hierarchy::ElementId leaf, hierarchy::LinkId, hierarchy::ElementId sender, float open,
            const KernelOf&) const;
  /// Appends a link's term when it may carry light.
  template <class KernelOf>
  void add(hierarchy::ElementId leaf, hierarchy::LinkId, const KernelOf&, std::vector<Term>& out) const;
  template <class KernelOf>
  std::vector<Term> allTerms(hierarchy::ElementId leaf, const KernelOf&) const;
  float closeWeight(hierarchy::ElementId leaf, const Term&) const;
  /// Takes terms apart until none weighs more than some rays' worth.
  template <class KernelOf>
  std::vector<Term> apart(hierarchy::ElementId leaf, std::vector<Term> whole, float ray, const KernelOf&) const;
  float guess(hierarchy::ElementId leaf, const hierarchy::PatchPoint& x, hierarchy::ElementId part) const;
  /// Deals `rays` out over terms; expected of each: its weight over `step`: visit(Dealt).
  template <class KernelOf, class Visit>
  void deal(hierarchy::ElementId leaf, const hierarchy::PatchPoint& center, const std::vector<Term>&, double step,
            int rays, const KernelOf&, const Visit&) const;
  /// Deals the rays of a term out over the leaves below its sender, in proportion to what each may bring to `x`.
  template <class KernelOf, class Visit>
  void dealBelow(hierarchy::ElementId leaf, const hierarchy::PatchPoint& x, const Term&, double expected, int rays,
                 const Roundings&, const KernelOf&, const Visit&) const;
  struct Place;
  paper::SampleKey rayKey(hierarchy::ElementId leaf, hierarchy::ElementId sender) const;
  /// The ray of a dealt term, from a point or anywhere on the leaf (null); no leaf where no points face each other.
  paper::SenderSample shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index,
                            const hierarchy::PatchPoint* at) const;
  paper::SenderSample shootMeasured(hierarchy::ElementId sender, paper::SampleKey key, int index, const Place&) const;
  /// `measures`: its weight tells the kernel, also of a flat sender.
  paper::SenderSample shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index, bool measures) const;
  paper::SenderSample shootOf(hierarchy::ElementId leaf, const RowTerm& t) const {
    return shoot(leaf, t.sender, t.index, t.measures || measures(leaf));
  }
  paper::SenderSample shootBack(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index, bool measures) const;
  paper::SenderSample shootMeasuring(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index) const;
  bool isClosePatch(hierarchy::ElementId leaf, hierarchy::ElementId sender) const;
  paper::SenderSample along(const ClosePair&, hierarchy::ElementId sender) const;
  struct Found {
    Rgb T{0.0f};  // black where the term brings nothing
    const tracing::Ray* ray = nullptr;
    float seen = 1;  // share of the ray up to what blocks it
    PrimitiveId blocker = {};
  };
  /// What a dealt term brings, by its ray.
  Found find(const Dealt&, const paper::SenderSample&, std::uint64_t& traced) const;
  /// Notes where the ray of one of the row's terms goes.
  void remember(hierarchy::ElementId leaf, std::size_t term, const Found&, TransferRow&) const;
  void append(hierarchy::ElementId leaf, const Dealt&, TransferRow&, std::uint64_t& traced) const;
  /// A term of a row that has to be traced again, and its ray.
  struct Again {
    std::uint32_t term;
    paper::SenderSample sample;
  };
  /// In ascending order.
  std::vector<Again> meeting(hierarchy::ElementId leaf, const paper::SpaceChange&, const TransferRow&) const;
  bool turn(hierarchy::ElementId leaf, const paper::LinkChanges&, std::span<const hierarchy::LinkId> changed,
            const paper::SpaceChange&, TransferRow&) const;
  bool relink(hierarchy::ElementId leaf, const paper::LinkChanges&, std::span<const hierarchy::LinkId> changed,
              TransferRow&) const;
  std::vector<Again> allOf(hierarchy::ElementId leaf, const TransferRow&) const;
  bool dropStale(const paper::LinkChanges&, std::span<const hierarchy::LinkId> changed, TransferRow&) const;
  bool suits(hierarchy::ElementId leaf, std::span<const Again>, int rays, const TransferRow&) const;
  bool uneven(hierarchy::ElementId leaf, std::span<const Again>, const TransferRow&) const;
  bool coveredBy(std::span<const hierarchy::LinkId> changed, const RowTerm&) const;
  Found findAgain(hierarchy::ElementId leaf, const RowTerm&, const paper::SenderSample&, std::uint64_t& traced) const;
  /// Whether any brings something else than before.
  bool retrace(hierarchy::ElementId leaf, std::span<const Again>, TransferRow&, std::uint64_t& traced) const;
  /// Appends the terms over changed links, by at most `most` rays; false when none bring anything.
  bool dealChanged(hierarchy::ElementId leaf, std::span<const hierarchy::LinkId> changed, int most, TransferRow&,
                   std::uint64_t& traced) const;
  float kernelAtLeaf(hierarchy::ElementId leaf, hierarchy::ElementId sender, bool clear) const;
  float kernelOverNodes(hierarchy::ElementId at, hierarchy::ElementId of) const;
  float kernelOverPairs(hierarchy::ElementId leaf, hierarchy::ElementId sender, int sets) const;
  float kernelOverPoints(hierarchy::ElementId leaf, hierarchy::ElementId sender) const;
  bool exact(hierarchy::ElementId sender) const;
  bool averted(hierarchy::ElementId leaf, hierarchy::ElementId sender) const;
  /// Whether rays of the leaf measure kernels, since parts of it see senders that others do not.
  bool measures(hierarchy::ElementId leaf) const {
    return !elements_.at(leaf).flat || elements_.shape(leaf).exposed < 1.0f;
  }
  /// Whether rays that are dealt now between the two do: also where parts of a sender are covered.
  bool measures(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
    return measures(leaf) || elements_.shape(sender).exposed < 1.0f;
  }
  /// Whether a term needs no ray.
  bool known(const Term& t) const { return t.open >= 1.0f && exact(t.sender); }
  float faintest(hierarchy::ElementId receiver) const;
  float level(hierarchy::ElementId receiver) const;
  float strength(hierarchy::ElementId receiver, hierarchy::ElementId sender) const;

  const Scene& scene_;
  const hierarchy::Elements& elements_;
  const tracing::RayTracer& tracer_;
  const hierarchy::Links& links_;
  PlaceCodes grid_;
};

}  // namespace deltalux::radiosity
