#pragma once
// The functions of deltalux/shape.hpp, kind by kind: one file per kind, joined in shape.cpp.
#include <deltalux/shape.hpp>

namespace deltalux::scene::kinds {

double area(const Polygon&);
double area(const Sphere&);
double area(const Cylinder&);
double area(const Cone&);
double area(const Ring&);
double area(const Mesh&);

Box bounds(const Polygon&);
Box bounds(const Sphere&);
Box bounds(const Cylinder&);
Box bounds(const Cone&);
Box bounds(const Ring&);
Box bounds(const Mesh&);

SurfacePoint pointAt(const Polygon&, Vec2 uv);
SurfacePoint pointAt(const Sphere&, Vec2 uv);
SurfacePoint pointAt(const Cylinder&, Vec2 uv);
SurfacePoint pointAt(const Cone&, Vec2 uv);
SurfacePoint pointAt(const Ring&, Vec2 uv);
SurfacePoint pointAt(const Mesh&, Vec2 uv);

Vec2 parameterAt(const Polygon&, const Vec3& p);
Vec2 parameterAt(const Sphere&, const Vec3& p);
Vec2 parameterAt(const Cylinder&, const Vec3& p);
Vec2 parameterAt(const Cone&, const Vec3& p);
Vec2 parameterAt(const Ring&, const Vec3& p);
Vec2 parameterAt(const Mesh&, const Vec3& p, std::uint32_t triangle);

bool covers(const Polygon&, Vec2 uv);
bool covers(const Mesh&, Vec2 uv);

SurfacePoint samplePoint(const Polygon&, Vec2 uniform);
SurfacePoint samplePoint(const Sphere&, Vec2 uniform);
SurfacePoint samplePoint(const Cylinder&, Vec2 uniform);
SurfacePoint samplePoint(const Cone&, Vec2 uniform);
SurfacePoint samplePoint(const Ring&, Vec2 uniform);
SurfacePoint samplePoint(const Mesh&, Vec2 uniform);

/// An affine map, with what the kinds ask of it.
struct ShapeMap {
  explicit ShapeMap(const Mat4&);

  Vec3 point(const Vec3& p) const { return linear * p + translation; }

  glm::dmat3 linear;
  Vec3 translation;
  bool mirrors;                 // determinant < 0
  std::optional<double> scale;  // lengths grow by this, all alike; nullopt for anything but a similarity
};

std::optional<Shape> transformed(const Polygon&, const ShapeMap&);
std::optional<Shape> transformed(const Sphere&, const ShapeMap&);
std::optional<Shape> transformed(const Cylinder&, const ShapeMap&);
std::optional<Shape> transformed(const Cone&, const ShapeMap&);
std::optional<Shape> transformed(const Ring&, const ShapeMap&);
std::optional<Shape> transformed(const Mesh&, const ShapeMap&);

/// Azimuth of (x, y) as a fraction of the full turn, in [0,1).
double turnOf(double x, double y);
/// Bounds of the circle of `radius` around `center` in the plane with unit `normal`.
Box circleBounds(const Vec3& center, const Vec3& normal, double radius);

/// A choice from a cumulative table by `uniform` in [0,1); what the choice leaves of `uniform` is uniform again.
struct Choice {
  std::uint32_t index;
  double remainder;
};
Choice choose(const std::vector<double>& cumulative, double uniform);

/// Barycentric weights of the second and third corner, uniform over a triangle.
Vec2 uniformInTriangle(Vec2 uniform);

}  // namespace deltalux::scene::kinds
