#pragma once
#include <algorithm>
#include <cmath>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <limits>

namespace deltalux::tracing {

/// A ray segment in single precision; direction is unit, t in scene units.
struct Ray {
  Vec3f origin{0.0f};
  float tNear = 0.0f;
  Vec3f direction{0.0f, 0.0f, 1.0f};
  float tFar = std::numeric_limits<float>::infinity();
};

/// The first surface on a ray. `normal` is the unit geometric normal of the primitive's front side; `front` tells
/// whether the ray came from that side. `triangle` is the mesh triangle (0 for other shapes).
struct Hit {
  float t = std::numeric_limits<float>::infinity();
  PrimitiveId primitive;
  std::uint32_t triangle = 0;
  Vec3f position{0.0f};  // on the surface to the last digit, which at(ray, t) is not
  Vec3f normal{0.0f, 0.0f, 1.0f};
  bool front = true;

  explicit operator bool() const { return primitive.valid(); }
};

inline Vec3f at(const Ray& ray, float t) { return ray.origin + t * ray.direction; }

/// `p` moved off its surface to the side of `direction`, enough for a ray from there not to meet the surface again. For
/// points that are rounded but not otherwise off their surface (Hit::position, SurfacePoint::position): the step is
/// some ten times the rounding of their coordinates, a thousandth of what tells surfaces 1 mm apart at 1 m.
inline Vec3f offsetOrigin(const Vec3f& p, const Vec3f& normal, const Vec3f& direction, float size) {
  const float step = 1e-6f * std::max(size, 1e-6f);
  return p + (glm::dot(normal, direction) >= 0.0f ? step : -step) * normal;
}
inline float largestCoordinate(const Vec3f& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }
inline Vec3f offsetOrigin(const Vec3f& p, const Vec3f& normal, const Vec3f& direction) {
  return offsetOrigin(p, normal, direction, largestCoordinate(p));
}

/// The open segment between two surface points, for visibility. Both ends leave their surfaces by the rounding of the
/// larger one: a ray from far away does not end more exactly because the point it ends at has small coordinates. A far
/// end without a normal (zero) is a point in space, which may sit right on a ceiling: the segment ends short of it.
inline Ray segment(const Vec3f& from, const Vec3f& fromNormal, const Vec3f& to, const Vec3f& toNormal) {
  const Vec3f d = to - from;
  const float size = std::max(largestCoordinate(from), largestCoordinate(to));
  const Vec3f a = offsetOrigin(from, fromNormal, d, size);
  const Vec3f b = offsetOrigin(to, toNormal, -d, size);
  const Vec3f ab = b - a;
  const float length = glm::length(ab);
  Ray ray;
  ray.origin = a;
  ray.direction = length > 0.0f ? ab / length : Vec3f(0.0f, 0.0f, 1.0f);
  const bool inSpace = toNormal.x == 0.0f && toNormal.y == 0.0f && toNormal.z == 0.0f;
  ray.tFar = inSpace ? length * (1.0f - 1e-5f) : length;
  return ray;
}

}  // namespace deltalux::tracing
