#pragma once
// What the tracer keeps of each triangle and user primitive that Embree knows by number.
#include <cmath>
#include <cstdint>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <vector>

#include "base/box_tree.hpp"

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

/// Boxes of user primitives and groups are wider by so much of the largest coordinate: what Embree's traversal, which
/// is not robust for them, may be off by on either side of its comparisons.
inline constexpr float kRounding = 4e-7f;  // [rounding]

struct TriangleTable {
  std::vector<TriangleRecord> records;
  std::vector<BoxF> boxes;  // around them as Embree has them, in single precision
};

/// Whether a ray enters a box, or passes it by less than Embree's robust traversal allows for: every node that holds
/// the box is entered then, whatever else it holds. What a triangle takes for a hit is not farther from its border, so
/// that of two that share an edge one is left.
bool enters(const Vec3& origin, const Vec3& direction, const BoxF&);

/// One of Embree's user primitives, with bounds that hold in single precision.
template <class Surface>
struct AnalyticRecord {
  /// `extent`: the largest coordinate of where rays come from.
  AnalyticRecord(const Surface&, PrimitiveId, const Box& bounds, float extent);

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
AnalyticRecord<Surface>::AnalyticRecord(const Surface& s, PrimitiveId id, const Box& box, float extent)
    : surface(s), primitive(id) {
  const Vec3 margin(kRounding * extent);
  lower = Vec3f(box.lower - margin), upper = Vec3f(box.upper + margin);
}

}  // namespace deltalux::tracing
