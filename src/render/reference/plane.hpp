#pragma once
// The planes of flat primitives, as mirrors.
#include <deltalux/shape.hpp>
#include <optional>

namespace deltalux::rendering {

/// Plane of a flat primitive (polygon, ring): a point and the unit normal of its front.
struct Plane {
  Vec3 point, normal;

  double height(const Vec3& x) const { return glm::dot(x - point, normal); }
  Vec3 image(const Vec3& x) const { return x - 2.0 * height(x) * normal; }
  Vec3 reflected(const Vec3& direction) const { return direction - 2.0 * glm::dot(direction, normal) * normal; }
};
std::optional<Plane> planeOf(const Shape&);
/// Whether the point `p` of the plane lies on the flat shape.
bool contains(const Shape& flat, const Vec3& p);

}  // namespace deltalux::rendering
