#pragma once
// The ray from a point of a surface to a sampled point of a light, or along its direction when that is at infinity.
#include <cmath>
#include <deltalux/scene.hpp>

#include "tracing/ray.hpp"

namespace deltalux::tracing {

/// The open segment from `from`, or the ray when `distance` is infinite; zero normals in free space.
inline Ray shadowRay(const Vec3& from, const Vec3& fromNormal, const Vec3& direction, double distance,
                     const Vec3& toNormal) {
  const Vec3f origin(from), normal(fromNormal), d(direction);
  if (!std::isinf(distance)) return segment(origin, normal, Vec3f(from + distance * direction), Vec3f(toNormal));
  Ray ray;
  ray.origin = offsetOrigin(origin, normal, d);
  ray.direction = d;
  return ray;
}

}  // namespace deltalux::tracing
