#pragma once
// Deals a whole number of rays out over parts, each its expected number rounded up or down: the parts are halved by
// place, over and over, and each half gets its share of the rays, rounded by a random number that depends on receiver
// and half alone. Neighbours so share their roundings (little variance, like systematic sampling), and when weights
// change a little few rays go elsewhere: near twins of a scene keep nearly all their rays, which systematic sampling,
// where all that follows shifts, does not.
// Cost: a sort; some ten nanoseconds a part.
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "hierarchy/element.hpp"
#include "radiosity/leaf_group.hpp"

namespace deltalux::radiosity {

/// Of `rays`, those of a part of the weight `part` among `whole`; expected: rays * part / whole. `u`: random in [0,1).
int shareOf(int rays, double part, double whole, double u);

/// The random numbers by which a leaf rounds, one for each thing that it deals out; those of its group are stratified
/// together. Radical inverses to base 4 of the path to the leaf, scrambled for each thing [Owen97].
class Roundings {
 public:
  Roundings(const hierarchy::Elements&, hierarchy::ElementId leaf);
  double of(std::uint64_t thing) const;

 private:
  LeafGroup group_;
  std::uint64_t own_;
};

/// Places as Morton codes on a grid that depends on the order of magnitude of the scene alone.
class PlaceCodes {
 public:
  explicit PlaceCodes(const hierarchy::Elements&);
  std::uint64_t code(const Vec3f&) const;

 private:
  float perUnit_ = 1;
};

struct RayShare {
  std::uint64_t place;  // code
  std::uint64_t key;    // tells parts at one place apart
  std::uint32_t index;  // the caller's
  float weight;         // > 0
};

namespace detail {

/// Half of the parts, by the highest bit in which their places differ.
const RayShare* halfOf(const RayShare* begin, const RayShare* end);
std::uint64_t keyOfHalf(const RayShare* begin, const RayShare* half);
void sortByPlace(std::vector<RayShare>&);

template <class Visit>
void dealHalves(const RayShare* begin, const RayShare* end, const double* sums, int rays, const Roundings& roundings,
                const Visit& visit) {
  if (rays == 0) return;
  if (begin + 1 == end) {
    visit(begin->index, rays);
    return;
  }
  const RayShare* half = halfOf(begin, end);
  const double part = sums[half - begin] - sums[0], whole = sums[end - begin] - sums[0];
  const int own = shareOf(rays, part, whole, roundings.of(keyOfHalf(begin, half)));
  dealHalves(begin, half, sums, own, roundings, visit);
  dealHalves(half, end, sums + (half - begin), rays - own, roundings, visit);
}

}  // namespace detail

/// Calls visit(index, rays) for each part that gets any, in the order of places.
template <class Visit>
void dealOut(std::vector<RayShare>& parts, int rays, const Roundings& roundings, const Visit& visit) {
  if (parts.empty()) return;
  detail::sortByPlace(parts);
  std::vector<double> sums(parts.size() + 1, 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i) sums[i + 1] = sums[i] + parts[i].weight;
  detail::dealHalves(parts.data(), parts.data() + parts.size(), sums.data(), rays, roundings, visit);
}

}  // namespace deltalux::radiosity
