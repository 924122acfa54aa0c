#pragma once
// What the tracer keeps of each triangle and user primitive that Embree knows by number.
#include <cmath>
#include <cstdint>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>

namespace deltalux::tracing {

enum class Passage : unsigned { Opaque = 1, Pane = 2 };  // ray masks

/// Rays closer than this to the plane of a triangle keep the t that Embree saw: the plane hardly tells.
inline constexpr double kGrazing = 1e-6;  // [rounding]

/// One of Embree's triangles, with the plane of its primitive: dot(normal, p) = offset.
struct TriangleRecord {
  TriangleRecord(PrimitiveId, std::uint32_t triangle, const Vec3& normal, const Vec3& point);
  /// Where the ray meets the plane, given where Embree saw it meet the triangle.
  double meet(const Vec3& origin, const Vec3& direction, float seen) const;

  Vec3 normal;  // unit
  double offset;
  PrimitiveId primitive;
  std::uint32_t triangle;  // in the mesh; 0 in polygons
};

/// One of Embree's user primitives, with bounds that hold in single precision.
template <class Surface>
struct AnalyticRecord {
  AnalyticRecord(const Surface&, PrimitiveId, const Box& bounds);

  Surface surface;
  PrimitiveId primitive;
  Vec3f lower, upper;
};

inline TriangleRecord::TriangleRecord(PrimitiveId id, std::uint32_t t, const Vec3& n, const Vec3& point)
    : normal(n), offset(glm::dot(n, point)), primitive(id), triangle(t) {}

inline double TriangleRecord::meet(const Vec3& origin, const Vec3& direction, float seen) const {
  const double cosine = glm::dot(normal, direction);
  return std::abs(cosine) > kGrazing ? (offset - glm::dot(normal, origin)) / cosine : seen;
}

template <class Surface>
AnalyticRecord<Surface>::AnalyticRecord(const Surface& s, PrimitiveId id, const Box& box) : surface(s), primitive(id) {
  // Wider than the box by what rounding may take, also on the ray's side of the comparison.
  const Vec3 margin = 4e-7 * glm::max(glm::abs(box.lower), glm::abs(box.upper));
  lower = Vec3f(box.lower - margin), upper = Vec3f(box.upper + margin);
}

}  // namespace deltalux::tracing
