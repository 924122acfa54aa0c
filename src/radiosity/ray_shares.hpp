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

namespace deltalux {

/// Of `rays`, those of a part of the weight `part` among `whole`; expected: rays * part / whole.
int shareOf(int rays, double part, double whole, std::uint64_t key);

/// Places as Morton codes on a grid that depends on the order of magnitude of the scene alone.
class PlaceCodes {
 public:
  explicit PlaceCodes(const Elements&);
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
void dealHalves(const RayShare* begin, const RayShare* end, const double* sums, int rays, std::uint64_t key,
                const Visit& visit) {
  if (rays == 0) return;
  if (begin + 1 == end) {
    visit(begin->index, rays);
    return;
  }
  const RayShare* half = halfOf(begin, end);
  const double part = sums[half - begin] - sums[0], whole = sums[end - begin] - sums[0];
  const int own = shareOf(rays, part, whole, combineKeys(key, keyOfHalf(begin, half)));
  dealHalves(begin, half, sums, own, key, visit);
  dealHalves(half, end, sums + (half - begin), rays - own, key, visit);
}

}  // namespace detail

/// Calls visit(index, rays) for each part that gets any, in the order of places. `key`: of the receiver.
template <class Visit>
void dealOut(std::vector<RayShare>& parts, int rays, std::uint64_t key, const Visit& visit) {
  if (parts.empty()) return;
  detail::sortByPlace(parts);
  std::vector<double> sums(parts.size() + 1, 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i) sums[i + 1] = sums[i] + parts[i].weight;
  detail::dealHalves(parts.data(), parts.data() + parts.size(), sums.data(), rays, key, visit);
}

}  // namespace deltalux
