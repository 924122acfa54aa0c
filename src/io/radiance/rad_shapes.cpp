#include "io/radiance/rad_shapes.hpp"

#include <cmath>
#include <numeric>

#include "scene/flat_outline.hpp"
#include "scene/hole_winding.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kNothing = 1e-12;  // of a length: a surface this small has no area [rounding]

Vec3 pointOf(const RadObject& object, std::size_t at) {
  return {object.reals[at], object.reals[at + 1], object.reals[at + 2]};
}

[[noreturn]] void fail(const RadObject& object, const std::string& message) {
  throw inputError(object.where, object.typeName + " '" + object.name + "': " + message);
}

/// The triangles around vertex 0 when they all face one way, else those of the outline flattened along `normal`.
std::vector<std::array<std::uint32_t, 3>> trianglesOfBent(const std::vector<Vec3>& vertices, const Vec3& normal) {
  std::vector<std::array<std::uint32_t, 3>> fan;
  for (std::uint32_t i = 1; i + 1 < vertices.size(); ++i) {
    const Vec3 facing = glm::cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
    if (glm::dot(facing, normal) <= 0) {
      std::vector<Vec3> flat = vertices;
      for (Vec3& v : flat) v -= glm::dot(v - vertices[0], normal) * normal;
      const auto polygon = makePolygon(flat);
      // Vertices may have been dropped as repeated; then the indices no longer fit.
      if (polygon && polygon->vertices.size() == vertices.size()) return polygon->triangles;
      return {};
    }
    fan.push_back({0, i, i + 1});
  }
  return fan;
}

std::vector<Shape> polygon(const RadObject& object) {
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i + 2 < object.reals.size(); i += 3) vertices.push_back(pointOf(object, i));
  if (auto planar = makePolygon(vertices)) return {std::move(*planar)};
  vertices = scene::inOrder(vertices, scene::windingOrder(vertices));
  const Vec3 area = scene::newellVector(vertices);
  if (!(glm::length(area) > 0)) return {};
  std::vector<Shape> shapes;
  for (const auto& [a, b, c] : trianglesOfBent(vertices, glm::normalize(area))) {
    if (auto triangle = makePolygon({vertices[a], vertices[b], vertices[c]})) shapes.emplace_back(std::move(*triangle));
  }
  return shapes;
}

std::vector<Shape> sphere(const RadObject& object, bool inward) {
  const double radius = object.reals[3];
  if (std::abs(radius) <= kNothing) return {};
  return {Sphere{pointOf(object, 0), std::abs(radius), inward != (radius < 0)}};
}

std::vector<Shape> cylinder(const RadObject& object, double radius, bool inward) {
  const Vec3 p0 = pointOf(object, 0), p1 = pointOf(object, 3);
  if (std::abs(radius) <= kNothing || glm::distance(p0, p1) <= kNothing) return {};
  return {Cylinder{p0, p1, std::abs(radius), inward != (radius < 0)}};
}

std::vector<Shape> cone(const RadObject& object, bool inward) {
  const double r0 = object.reals[6], r1 = object.reals[7];
  if (r0 * r1 < 0) fail(object, "its radii have different signs");
  if (std::abs(r0 - r1) <= kNothing * std::max(std::abs(r0), std::abs(r1))) return cylinder(object, r0, inward);
  const Vec3 p0 = pointOf(object, 0), p1 = pointOf(object, 3);
  if (glm::distance(p0, p1) <= kNothing) return {};
  return {Cone{p0, p1, std::abs(r0), std::abs(r1), inward != (r0 < 0 || r1 < 0)}};
}

std::vector<Shape> ring(const RadObject& object) {
  const Vec3 normal = pointOf(object, 3);
  if (!(glm::length(normal) > 0)) fail(object, "its normal is zero");
  double inner = object.reals[6], outer = object.reals[7];
  if (inner < 0 || outer < 0) fail(object, "a radius is negative");
  if (inner > outer) std::swap(inner, outer);
  if (outer - inner <= kNothing * outer || outer <= kNothing) return {};
  return {Ring{pointOf(object, 0), glm::normalize(normal), inner, outer}};
}

}  // namespace

std::vector<Shape> makeShapes(const RadObject& object) {
  switch (object.type) {
    case Type::Polygon:
      return polygon(object);
    case Type::Sphere:
      return sphere(object, false);
    case Type::Bubble:
      return sphere(object, true);
    case Type::Cylinder:
      return cylinder(object, object.reals[6], false);
    case Type::Tube:
      return cylinder(object, object.reals[6], true);
    case Type::Cone:
      return cone(object, false);
    case Type::Cup:
      return cone(object, true);
    case Type::Ring:
      return ring(object);
    case Type::GeneratedMesh:
      return {*object.mesh};
    default:
      return {};
  }
}

}  // namespace deltalux::io::radiance
