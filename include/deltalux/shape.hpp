#pragma once
// High-level primitives, never pre-tessellated: each has an implicit parameterisation (u,v) in [0,1]^2 that carries
// quadtree patches, particle impacts and caustic textures. [GD01 6.2]
//
//   Polygon   (u,v) spans the bounding parallelogram of its plane (an exact fit for parallelograms); parts of [0,1]^2
//             may lie outside the polygon (covers() tells).
//   Sphere    u azimuth, v = (1 + cos theta) / 2 about +z: equal areas.
//   Cylinder  u azimuth, v along the axis: equal areas.
//   Cone      u azimuth, v along the axis, 0 at p0 (frustum: the area element grows with the radius).
//   Ring      u azimuth, v = (r^2 - r0^2) / (r1^2 - r0^2): equal areas.
//   Mesh      triangle t fills half of cell t/2 of a square grid of cells, so a point of any mesh has its own (u,v).
// Radii > 0, lengths in scene units. The front side is where the normal points.
#include <array>
#include <cstdint>
#include <deltalux/math.hpp>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace deltalux {

/// A planar polygon; holes are seams (an edge walked there and back), as in Radiance. Build it with makePolygon.
struct Polygon {
  std::vector<Vec3> vertices;                      // counter-clockwise seen from the front
  Vec3 normal{0, 0, 1};                            // unit
  Vec3 origin{0}, edgeU{1, 0, 0}, edgeV{0, 1, 0};  // (u,v) -> origin + u edgeU + v edgeV; edgeU x edgeV is in front
  Vec3 dualU{1, 0, 0}, dualV{0, 1, 0};             // p -> (dot(p - origin, dualU), dot(p - origin, dualV))
  double area = 0;
  bool fillsFrame = false;                              // a parallelogram: covers() everywhere
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices, front-facing
  std::vector<Vec2> outline;                            // (u,v) of the vertices
  std::vector<double> cumulativeArea;                   // of triangles[0..t]
};

struct Sphere {
  Vec3 center{0};
  double radius = 1;
  bool inward = false;  // bubble: the normal points to the centre
};

struct Cylinder {
  Vec3 p0{0}, p1{0, 0, 1};
  double radius = 1;
  bool inward = false;  // tube
};

struct Cone {
  Vec3 p0{0}, p1{0, 0, 1};
  double radius0 = 1, radius1 = 0;  // at p0 and p1
  bool inward = false;              // cup
};

struct Ring {
  Vec3 center{0}, normal{0, 0, 1};
  double innerRadius = 0, outerRadius = 1;
};

/// Build it with makeMesh.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;                            // empty, or one per position (unit); shading only
  std::vector<Vec2> texcoords;                          // empty, or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from the front
  std::vector<double> cumulativeArea;                   // of triangles[0..t]
};

using Shape = std::variant<Polygon, Sphere, Cylinder, Cone, Ring, Mesh>;

/// A point of a surface: position, unit geometric normal of the front side, parameters, and for meshes the triangle.
struct SurfacePoint {
  Vec3 position{0};
  Vec3 normal{0, 0, 1};
  Vec2 uv{0};
  std::uint32_t triangle = 0;
};

/// The polygon of `vertices` (at least 3), with plane, parameter frame and triangulation. nullopt when it has no area
/// or no plane. Vertices off the plane are projected onto it when the polygon is planar within 1e-3 of its size;
/// a vertex that repeats the one before it is dropped.
std::optional<Polygon> makePolygon(std::vector<Vec3> vertices);

/// The mesh of `triangles`, less those without area. nullopt when none is left. `normals` and `texcoords` are empty or
/// one per position, and the indices in range (checked: misuse).
std::optional<Mesh> makeMesh(std::vector<Vec3> positions, std::vector<std::array<std::uint32_t, 3>> triangles,
                             std::vector<Vec3> normals = {}, std::vector<Vec2> texcoords = {});

/// Surface area of one side [unit^2].
double area(const Shape&);
Box bounds(const Shape&);

/// The point at (u,v) in [0,1]^2, also where covers() is false (polygon's plane beyond its edges).
SurfacePoint pointAt(const Shape&, Vec2 uv);
/// Parameters of the surface point nearest to `p` (for meshes: on `triangle`). Inverse of pointAt on the surface.
Vec2 parameterAt(const Shape&, const Vec3& p, std::uint32_t triangle = 0);
/// Whether (u,v) lies on the surface itself: false in the parts of [0,1]^2 that a polygon or mesh leaves empty.
bool covers(const Shape&, Vec2 uv);
/// A point uniform by area from two uniform numbers in [0,1).
SurfacePoint samplePoint(const Shape&, Vec2 uniform);

/// The shape after an affine map. nullopt when the map turns a curved shape into one that is not of its kind
/// (anything but a similarity), or degenerates it. Mirroring maps keep the front side in front.
std::optional<Shape> transformed(const Shape&, const Mat4&);

/// How many polygons an ordinary tessellation would need (curved shapes: 24 steps around, spheres 24 x 12).
std::size_t tessellatedPolygonCount(const Shape&);

}  // namespace deltalux
