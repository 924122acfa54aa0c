#pragma once
// Rays against primitives that are not left to single-precision triangles, analytically: the crossings of a line with a
// sphere, a cylinder, a cone frustum, a ring or a thin triangle, and the normal there.
//
// Everything is computed in double precision from a point of the ray near the primitive, so that small primitives far
// from the ray's origin keep their shape: t and normal are good to single precision. [Haines19]
#include <deltalux/shape.hpp>

namespace deltalux::tracing {

/// Parameters of the points where a line meets a surface, ascending.
struct Crossings {
  std::array<double, 2> t;
  int count = 0;

  void add(double at) { t[static_cast<std::size_t>(count++)] = at; }
};

struct SphereSurface {
  explicit SphereSurface(const Sphere&);
  Crossings crossings(const Vec3& origin, const Vec3& direction) const;
  Vec3 normal(const Vec3& p) const { return (p - center) * perRadius; }

  Vec3 center;
  double radiusSquared;
  double perRadius;  // 1 / radius, negative for bubbles
};

struct CylinderSurface {
  explicit CylinderSurface(const Cylinder&);
  Crossings crossings(const Vec3& origin, const Vec3& direction) const;
  Vec3 normal(const Vec3& p) const;

  Vec3 base, axis;
  double height;
  double radiusSquared;
  double perRadius;  // 1 / radius, negative for tubes
};

struct ConeSurface {
  explicit ConeSurface(const Cone&);
  Crossings crossings(const Vec3& origin, const Vec3& direction) const;
  Vec3 normal(const Vec3& p) const;

  Vec3 base, axis;
  double height;
  double radius, slope;  // radius at the base; its growth per length of axis
  double side;           // -1 for cups
};

struct RingSurface {
  explicit RingSurface(const Ring&);
  Crossings crossings(const Vec3& origin, const Vec3& direction) const;
  Vec3 normal(const Vec3&) const { return front; }

  Vec3 center, front;
  double innerSquared, outerSquared;
};

/// A triangle too thin for vertices rounded to single precision.
struct ThinTriangleSurface {
  ThinTriangleSurface(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& unitNormal);
  Crossings crossings(const Vec3& origin, const Vec3& direction) const;
  Vec3 normal(const Vec3&) const { return front; }

  std::array<Vec3, 3> corners;
  Vec3 front;
};

}  // namespace deltalux::tracing
