#include <algorithm>
#include <cmath>

#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

namespace {

void mapPoint(std::vector<double>& reals, std::size_t at, const Transform& t) {
  const Vec3 p = t.point({reals[at], reals[at + 1], reals[at + 2]});
  for (int axis = 0; axis < 3; ++axis) reals[at + static_cast<std::size_t>(axis)] = p[axis];
}

void mapVector(std::vector<double>& reals, std::size_t at, const Transform& t, double factor = 1) {
  const Vec3 v = factor * t.vector({reals[at], reals[at + 1], reals[at + 2]});
  for (int axis = 0; axis < 3; ++axis) reals[at + static_cast<std::size_t>(axis)] = v[axis];
}

void reverseVertices(std::vector<double>& reals) {
  for (std::size_t i = 0, j = reals.size(); i + 3 < j; i += 3) {
    j -= 3;
    std::swap_ranges(reals.begin() + static_cast<std::ptrdiff_t>(i), reals.begin() + static_cast<std::ptrdiff_t>(i) + 3,
                     reals.begin() + static_cast<std::ptrdiff_t>(j));
  }
}

/// The face of the other side: -I makes a sphere a bubble and back.
void turnInsideOut(RadObject& object) {
  const auto become = [&](Type type, const char* name) { object.type = type, object.typeName = name; };
  switch (object.type) {
    case Type::Sphere:
      return become(Type::Bubble, "bubble");
    case Type::Bubble:
      return become(Type::Sphere, "sphere");
    case Type::Cylinder:
      return become(Type::Tube, "tube");
    case Type::Tube:
      return become(Type::Cylinder, "cylinder");
    case Type::Cone:
      return become(Type::Cup, "cup");
    case Type::Cup:
      return become(Type::Cone, "cone");
    default:
      return;
  }
}

std::shared_ptr<const Mesh> mapped(const Mesh& mesh, const Transform& t, bool reverse, bool invert) {
  auto result = std::make_shared<Mesh>(mesh);
  for (Vec3& p : result->positions) p = t.point(p);
  for (Vec3& n : result->normals) n = (invert ? -1.0 : 1.0) * glm::normalize(t.vector(n));
  if (reverse) {
    for (auto& triangle : result->triangles) std::swap(triangle[1], triangle[2]);
  }
  return result;
}

void mapSurface(RadObject& object, const Placement& placement) {
  const Transform& t = placement.transform;
  std::vector<double>& reals = object.reals;
  // A mirrored outline runs backwards; turning it keeps the front in front.
  const bool reverse = t.mirrored != placement.invert;
  switch (object.type) {
    case Type::Polygon:
      for (std::size_t i = 0; i + 2 < reals.size(); i += 3) mapPoint(reals, i, t);
      if (reverse) reverseVertices(reals);
      break;
    case Type::Sphere:
    case Type::Bubble:
      mapPoint(reals, 0, t);
      reals[3] *= t.scale;
      break;
    case Type::Cylinder:
    case Type::Tube:
    case Type::Cone:
    case Type::Cup:
      mapPoint(reals, 0, t), mapPoint(reals, 3, t);
      for (std::size_t i = 6; i < reals.size(); ++i) reals[i] *= t.scale;
      break;
    case Type::Ring:
      mapPoint(reals, 0, t), mapVector(reals, 3, t, placement.invert ? -1 : 1);
      reals[6] *= t.scale, reals[7] *= t.scale;
      break;
    case Type::Source:
      mapVector(reals, 0, t);
      break;
    case Type::GeneratedMesh:
      object.mesh = mapped(*object.mesh, t, reverse, placement.invert);
      break;
    default:
      break;
  }
  if (placement.invert) turnInsideOut(object);
  if (!placement.modifier.empty()) object.modifier = placement.modifier;
  if (!placement.namePrefix.empty()) object.name = placement.namePrefix + "." + object.name;
}

void mapModifier(RadObject& object, const Transform& t) {
  std::vector<double>& reals = object.reals;
  switch (object.type) {
    case Type::Glow:
      reals[3] *= t.scale;
      break;
    case Type::Spotlight:
      mapVector(reals, 4, t);
      break;
    case Type::Dielectric:
      // Transmission per unit length, in the units after the transform.
      for (std::size_t i = 0; i < 3; ++i) reals[i] = std::pow(std::max(reals[i], 0.0), 1 / t.scale);
      break;
    case Type::SkyBrightness:
      mapVector(reals, 4, t, 1 / t.scale), mapVector(reals, 7, t, 1 / t.scale);
      break;
    case Type::PerezBrightness:
      mapVector(reals, 7, t, 1 / t.scale), mapVector(reals, 10, t, 1 / t.scale);
      break;
    case Type::Pattern:
      object.toWorld = std::make_shared<const Mat4>(object.toWorld ? t.matrix * *object.toWorld : t.matrix);
      break;
    default:
      break;
  }
}

}  // namespace

RadObject placed(const RadObject& object, const Placement& placement) {
  RadObject result = object;
  if (isSurface(result.type)) {
    mapSurface(result, placement);
  } else {
    mapModifier(result, placement.transform);
  }
  return result;
}

}  // namespace deltalux::io::radiance
