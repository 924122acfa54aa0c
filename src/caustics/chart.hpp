#pragma once
// Charts: the flat pictures of a surface that caustic textures are drawn on. The parameters (u,v) of a shape serve
// subdivision; reconstruction wants lengths that are true, or kernels become ellipses and poles become long wedges. So
// textures have coordinates (s,t) of their own, in scene units of length:
//
//   Polygon, ring  the plane itself, the smallest rectangle around them; what lies beyond the outline is masked.
//   Cylinder, cone s around (at the widest circle), t along the side: closed in s, area element r(t) / r_max.
//   Sphere         the same with t from pole to pole.
//   Mesh           plane charts: patches of connected triangles within 45 degrees of their first one's plane, projected
//                  onto it. Texture coordinates would not do: they may tile or overlap, and say nothing of lengths.
// All charts but a mesh's keep areas exactly; a mesh's know the area of each triangle.
#include <deltalux/shape.hpp>
#include <utility>

namespace deltalux::caustics {

/// An orthonormal frame of a plane.
struct PlaneChart {
  Vec3 origin{0}, alongS{1, 0, 0}, alongT{0, 1, 0};
};

/// A surface of revolution, unrolled. The radius at distance t along the profile is r(t) = radius0 + slope t, or that
/// of a sphere of `radius0`.
struct TurnChart {
  double radius0 = 1, slope = 0;
  bool sphere = false;

  double radiusAt(double t) const { return sphere ? radius0 * std::sin(t / radius0) : radius0 + slope * t; }
};

struct Chart {
  std::variant<PlaneChart, TurnChart> map;
  Vec2 size{1};  // the surface's picture lies in [0, size.x] x [0, size.y]

  /// Whether s and s + size.x are one place.
  bool closed() const { return std::holds_alternative<TurnChart>(map); }
  /// Whether the rim t = 0 (t = size.y) is one point.
  bool poleAtStart() const { return closed() && stretch(0) < 1e-9; }
  bool poleAtEnd() const { return closed() && stretch(size.y) < 1e-9; }
  /// True length across, per unit of s, at t.
  double stretch(double t) const;
  /// Area per unit of s between t0 and t1.
  double bandArea(double t0, double t1) const;
  /// (s,t) of a surface point.
  Vec2 place(const SurfacePoint&) const;
};

struct Charts {
  std::vector<Chart> all;
  std::vector<std::uint32_t> ofTriangle;  // a mesh's triangle -> its chart; empty otherwise: all lies in the first

  std::size_t indexOf(std::uint32_t triangle) const { return ofTriangle.empty() ? 0 : ofTriangle[triangle]; }
};

/// Cost of a mesh: sorting its corners, then one visit per triangle.
Charts chartsOf(const Shape&);

/// The surface point at an impact's parameters (for meshes: of the triangle).
SurfacePoint impactPoint(const Shape&, const glm::vec2& uv, std::uint32_t triangle);

}  // namespace deltalux::caustics
