#pragma once
// The level at which the particles of a leaf are spread, chosen per input-level surface by the least estimated error:
// the tree of patches is cut where the sum of
//
//   J = (2 sum w^2 - (sum w)^2) / A
//
// over the cut is least, w being the particles' fluxes and A a patch's area: the cross-validated squared error of a
// histogram [Rudemo82]. No threshold, and much light on few particles is not mistaken for detail.
//
// A patch is too small for its particles, too, when light sent round between such patches could grow without end: when
// it would get more from surfaces of radiosity 1 all around than they could send it over one surface that reflects what
// those of the particles' links do, and either twice what they could over any number of such surfaces, as within a
// brass tube, or so much that, with the 1 that comes straight, it would send back more than there is all around. Energy
// is kept, except where a whole surface is that small.
// Cost: 20 nanoseconds a patch of the surface.
#include <algorithm>
#include <span>
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::particles {

/// What an element can get back of what surfaces all around send, when each has a radiosity of 1.
struct Feedback {
  double flux = 0;
  double once = 0;   // area that they could send as much to, over one surface like those of the links
  double often = 0;  // the same over any number of them

  void operator+=(const Feedback& o) { flux += o.flux, once += o.once, often += o.often; }
  void operator-=(const Feedback& o) { flux -= o.flux, once -= o.once, often -= o.often; }
};

/// Of an impact of a path from a surface: flux per radiosity, largest channel, over a link of that albedo.
inline Feedback feedbackOf(double flux, double albedo) {
  return {flux, flux / albedo, flux * std::max(0.0, 1 - albedo) / albedo};
}

/// Of the impacts on an element itself.
struct DepositSums {
  double weight = 0, squares = 0;  // by nominal senders
  Feedback feedback;
  std::uint32_t count = 0;  // of impacts

  void operator+=(const DepositSums& o) {
    weight += o.weight, squares += o.squares, count += o.count, feedback += o.feedback;
  }
};

/// A patch and all below it, in an order in which everything below a patch stands right behind it.
struct PatchTree {
  struct Place {
    hierarchy::ElementId element;
    std::uint32_t parent;  // place
  };
  std::vector<Place> places;

  void list(const hierarchy::Elements&, hierarchy::ElementId top);
};

class SpreadLevels {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  /// Cuts the trees of these input-level patches, each listed once. `sums`: by element.
  void choose(std::span<const hierarchy::ElementId> surfaces, const hierarchy::Elements&,
              const std::vector<DepositSums>& sums);

  /// The element that the particles of `e` are spread over; none for what stands above one.
  std::uint32_t of(hierarchy::ElementId e) const { return of_[e.index()]; }
  /// Share that is taken of what surfaces send to such an element.
  double damping(std::uint32_t level) const { return damping_[level]; }
  std::size_t memoryBytes() const { return 4 * (of_.capacity() + damping_.capacity()); }

 private:
  struct Cut;
  void choose(const hierarchy::Elements&, const std::vector<DepositSums>&, const PatchTree&, std::vector<Cut>&);

  std::vector<std::uint32_t> of_;  // by element
  std::vector<float> damping_;     // by element
};

}  // namespace deltalux::particles
