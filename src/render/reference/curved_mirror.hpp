#pragma once
// Single mirror reflections off spheres, cylinders and cones: all points that throw light from a given place (or a
// direction at infinity) to a given point, and how much the reflection spreads the light.
//
// A point s of a surface of revolution reflects y to x when the mirror image of x in the tangent plane at s, joined
// with y, meets that plane at s. The tangent plane is the same along a generatrix, so what remains is one equation in
// the azimuth: a trigonometric polynomial of degree 2, with at most four roots, all found by bracketing. For a sphere
// it is Alhazen's problem in the plane of x, y and the centre. The spread follows the wavefront's curvature through the
// reflection (Coddington's equations), so no derivative is taken numerically.
// Cost: about a microsecond a pair of points.
#include <array>
#include <deltalux/shape.hpp>

namespace deltalux::rendering {

/// A place in the scene, or for infinitely distant light the unit direction towards it.
struct LightPlace {
  Vec3 at;
  bool infinite = false;
};

struct MirrorPoint {
  Vec3 position;
  Vec3 normal;  // unit, on the side of both ends
  bool front;   // that side is the shape's front
};

/// Up to four mirror points.
struct MirrorPoints {
  std::array<MirrorPoint, 4> points;
  int count = 0;
};

/// Whether mirrorPoints() knows the shape.
bool isCurvedMirror(const Shape&);
/// Every point of `shape` that reflects light from `light` to `x`, whatever stands in between.
MirrorPoints mirrorPoints(const Shape& shape, const Vec3& x, const LightPlace& light);

/// How a cone of rays that leaves `x` spreads after its reflection at `s`: cross-section per solid angle at distance
/// `after` behind it [unit^2/sr], or solid angle per solid angle far away (`after` infinite).
double reflectedSpread(const Shape& shape, const Vec3& x, const Vec3& s, double after);

}  // namespace deltalux::rendering
