#include "render/solution_mesh/plane_groups.hpp"

#include <algorithm>
#include <deltalux/solution_mesh.hpp>

#include "base/box_tree.hpp"
#include "base/disjoint_sets.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kOnePlane = 1 - 1e-7;  // cosine between normals [rounding]
constexpr double kTouching = 2e-6;      // of the polygons' size: distance within which they touch [rounding]

std::uint32_t sideNumber(std::uint32_t primitive, bool front) { return 2 * primitive + (front ? 0 : 1); }

}  // namespace

std::vector<std::vector<std::uint32_t>> planeGroups(const Scene& scene) {
  std::vector<std::uint32_t> polygons;
  std::vector<BoxF> boxes;
  std::vector<char> there(scene.primitives.size());
  for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
    const Shape& shape = scene.primitives[p].shape;
    there[p] = area(shape) > 0;
    if (!there[p] || !std::holds_alternative<Polygon>(shape)) continue;
    polygons.push_back(p);
    const Box box = bounds(shape);
    const Vec3 slack(kTouching * (box.diagonal() + glm::length(box.center())));
    boxes.push_back({Vec3f(box.lower - slack), Vec3f(box.upper + slack)});
  }
  const BoxTree tree(boxes);
  DisjointSets groups(2 * scene.primitives.size());
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const auto& a = std::get<Polygon>(scene.primitives[polygons[i]].shape);
    tree.overlapping(boxes[i], [&](std::uint32_t j) {
      if (j <= i) return;
      const auto& b = std::get<Polygon>(scene.primitives[polygons[j]].shape);
      const double cosine = glm::dot(a.normal, b.normal);
      const double size = std::sqrt(std::max(a.area, b.area));
      if (std::abs(cosine) < kOnePlane || std::abs(glm::dot(b.origin - a.origin, a.normal)) > kTouching * size) return;
      for (const bool front : {true, false})
        groups.join(sideNumber(polygons[i], front), sideNumber(polygons[j], front == (cosine > 0)));
    });
  }
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<std::uint32_t> place(2 * scene.primitives.size());
  for (std::uint32_t side = 0; side < place.size(); ++side) {
    if (!there[side / 2]) continue;
    const std::uint32_t first = groups.of(side);
    if (first == side) {
      place[side] = static_cast<std::uint32_t>(result.size());
      result.emplace_back();
    }
    result[place[first]].push_back(side);
  }
  return result;
}

double touchingDistance(const Scene& scene, const std::vector<std::uint32_t>& group) {
  Box box;
  for (const std::uint32_t side : group) {
    const Shape& shape = scene.primitives[side / 2].shape;
    if (!std::holds_alternative<Polygon>(shape) && !std::holds_alternative<Mesh>(shape)) return kTouching;  // in (u,v)
    box.extend(bounds(shape));
  }
  return kTouching * box.diagonal();
}

}  // namespace deltalux::rendering
