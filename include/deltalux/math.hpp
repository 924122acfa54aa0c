#pragma once
// Vectors, boxes and directions. Scenes are described in double precision, rays run in single precision.
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

namespace deltalux {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec3f = glm::vec3;
using Mat4 = glm::dmat4;  // column-major as glm keeps it; applied as M * (p, 1)

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Axis-aligned box; default-constructed it is empty.
struct Box {
  Vec3 lower{kInfinity};
  Vec3 upper{-kInfinity};

  bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  void extend(const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void extend(const Box& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  Vec3 center() const { return 0.5 * (lower + upper); }
  Vec3 extent() const { return upper - lower; }
  double diagonal() const { return empty() ? 0.0 : glm::length(extent()); }
  bool overlaps(const Box& b) const {
    return glm::all(glm::lessThanEqual(lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, upper));
  }
  bool contains(const Vec3& p) const {
    return glm::all(glm::lessThanEqual(lower, p)) && glm::all(glm::lessThanEqual(p, upper));
  }
};

/// Right-handed orthonormal frame around the unit vector `n`.
struct Frame {
  Vec3 tangent, bitangent, normal;

  explicit Frame(const Vec3& n) : normal(n) {
    // Duff et al. 2017, "Building an Orthonormal Basis, Revisited": branch on the sign only.
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    tangent = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 toWorld(const Vec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
  Vec3 toLocal(const Vec3& v) const { return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)}; }
};

}  // namespace deltalux
