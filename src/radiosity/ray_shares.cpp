#include "radiosity/ray_shares.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace deltalux::radiosity {

namespace {

constexpr int kBits = 20;  // of a coordinate

/// Two zero bits before each of the lower 21.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

}  // namespace

int shareOf(int rays, double part, double whole, double u) {
  if (!(part > 0)) return 0;
  if (!(part < whole)) return rays;
  return std::min(rays, static_cast<int>(rays * (part / whole) + u));
}

Roundings::Roundings(const hierarchy::Elements& elements, hierarchy::ElementId leaf)
    : group_(groupOf(elements, leaf)), own_(elements.key[leaf.index()]) {}

double Roundings::of(std::uint64_t thing) const {
  std::uint64_t scramble = combineKeys(group_.key, thing);
  double u = 0, width = 1;
  for (int level = 0; level < LeafGroup::kLevels; ++level) {
    const unsigned digit = group_.place >> (2 * level) & 3u;
    width *= 0.25, u += width * (digit ^ static_cast<unsigned>(scramble >> 62));
    scramble = combineKeys(scramble, digit);
  }
  return u + width * toUnit(mix64(combineKeys(own_, thing)));
}

PlaceCodes::PlaceCodes(const hierarchy::Elements& elements) {
  if (!elements.sceneRoot.valid()) return;
  const hierarchy::ElementGeometry& root = elements.shape(elements.sceneRoot);
  const Vec3f most = glm::max(glm::abs(root.lower), glm::abs(root.upper));
  const float extent = std::max({most.x, most.y, most.z, 1e-30f});
  perUnit_ = std::ldexp(1.0f, kBits - 1 - std::ilogb(extent));
}

std::uint64_t PlaceCodes::code(const Vec3f& p) const {
  const auto cell = [&](float x) {
    const float c = std::clamp(x * perUnit_, -0x1p20f, 0x1p20f - 1.0f);
    return spread(static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(c)) + (std::int64_t(1) << kBits)));
  };
  return cell(p.x) << 2 | cell(p.y) << 1 | cell(p.z);
}

namespace detail {

const RayShare* halfOf(const RayShare* begin, const RayShare* end) {
  const std::uint64_t first = begin->place, last = (end - 1)->place;
  if (first == last) return begin + 1;
  const std::uint64_t bit = std::uint64_t(1) << (63 - std::countl_zero(first ^ last));
  const std::uint64_t split = (last & ~(bit - 1));
  return std::partition_point(begin, end, [&](const RayShare& s) { return s.place < split; });
}

std::uint64_t keyOfHalf(const RayShare* begin, const RayShare* half) {
  const std::uint64_t first = (half - 1)->place, second = half->place;
  if (first == second) return combineKeys(begin->place, begin->key);
  const int bit = 63 - std::countl_zero(first ^ second);
  return combineKeys(second >> bit, static_cast<std::uint64_t>(bit));
}

void sortByPlace(std::vector<RayShare>& parts) {
  std::sort(parts.begin(), parts.end(), [](const RayShare& a, const RayShare& b) {
    return a.place != b.place ? a.place < b.place : a.key < b.key;
  });
}

}  // namespace detail

}  // namespace deltalux::radiosity
