#include "export/atlas_regions.hpp"

#include <bit>
#include <unordered_map>

#include "base/random.hpp"

namespace deltalux::exporting {

namespace {

constexpr std::uint32_t kFree = 0xffffffffu;  // [sentinel]

struct PositionHash {
  std::size_t operator()(const Vec3f& p) const {
    const auto bits = [](float x) { return std::uint64_t(std::bit_cast<std::uint32_t>(x + 0.0f)); };  // -0 is 0
    return combineKeys(combineKeys(bits(p.x), bits(p.y)), bits(p.z));
  }
};

/// Triangles by the edges that they share.
class Neighbours {
 public:
  Neighbours(const SurfaceMesh& side, const std::vector<std::uint32_t>& triangles) : side_(side) {
    for (const std::uint32_t t : triangles)
      for (int k = 0; k < 3; ++k) byEdge_[edgeOf(t, k)].push_back(t);
  }

  template <class Visit>
  void of(std::uint32_t triangle, const Visit& visit) {
    for (int k = 0; k < 3; ++k)
      for (const std::uint32_t t : byEdge_[edgeOf(triangle, k)])
        if (t != triangle) visit(t);
  }

 private:
  std::uint64_t edgeOf(std::uint32_t triangle, int k) {
    const std::uint64_t a = pointOf(side_.triangles[3 * triangle + static_cast<std::uint32_t>(k)]);
    const std::uint64_t b = pointOf(side_.triangles[3 * triangle + static_cast<std::uint32_t>((k + 1) % 3)]);
    return std::min(a, b) << 32 | std::max(a, b);
  }
  std::uint32_t pointOf(std::uint32_t vertex) {
    return points_.try_emplace(side_.vertices[vertex].position, vertex).first->second;
  }

  const SurfaceMesh& side_;
  std::unordered_map<Vec3f, std::uint32_t, PositionHash> points_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> byEdge_;
};

Vec3 unitOrZero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3(0);
}

}  // namespace

Vec3 areaNormal(const SurfaceMesh& side, std::uint32_t triangle) {
  const auto at = [&](std::uint32_t k) { return Vec3(side.vertices[side.triangles[3 * triangle + k]].position); };
  return glm::cross(at(1) - at(0), at(2) - at(0));
}

std::vector<std::vector<std::uint32_t>> regionsOf(const SurfaceMesh& side, const std::vector<std::uint32_t>& triangles,
                                                  double crease) {
  Neighbours neighbours(side, triangles);
  std::vector<std::uint32_t> regionOf(side.triangles.size() / 3, kFree);
  std::vector<std::vector<std::uint32_t>> regions;
  const double leastCosine = std::cos(crease);
  for (const std::uint32_t seed : triangles) {
    if (regionOf[seed] != kFree) continue;
    const auto region = static_cast<std::uint32_t>(regions.size());
    Vec3 axis = unitOrZero(areaNormal(side, seed));
    std::vector<std::uint32_t> members{seed};
    regionOf[seed] = region;
    for (std::size_t next = 0; next < members.size(); ++next)
      neighbours.of(members[next], [&](std::uint32_t t) {
        if (regionOf[t] != kFree) return;
        const Vec3 normal = unitOrZero(areaNormal(side, t));
        if (normal != Vec3(0) && axis == Vec3(0)) axis = normal;
        if (normal != Vec3(0) && glm::dot(normal, axis) < leastCosine) return;
        regionOf[t] = region;
        members.push_back(t);
      });
    regions.push_back(std::move(members));
  }
  return regions;
}

}  // namespace deltalux::exporting
