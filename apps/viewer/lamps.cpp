#include "lamps.hpp"

#include <algorithm>

namespace deltalux::viewer {

namespace {

const SpotCone* coneOf(const Scene& scene, const AreaLight& light) {
  const auto& emission = scene.materialOf(light.primitive).emission;
  return emission && emission->spot ? &*emission->spot : nullptr;
}

/// A surface that bends round has no side that it shines to.
std::optional<Vec3> normalOf(const Shape& shape) {
  if (std::holds_alternative<Polygon>(shape)) return std::get<Polygon>(shape).normal;
  if (std::holds_alternative<Ring>(shape)) return std::get<Ring>(shape).normal;
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return std::nullopt;
  Vec3 sum(0);  // twice the area vector: 0 for closed meshes
  double whole = 0;
  for (const auto& t : mesh->triangles) {
    const Vec3 cross =
        glm::cross(mesh->positions[t[1]] - mesh->positions[t[0]], mesh->positions[t[2]] - mesh->positions[t[0]]);
    sum += cross, whole += glm::length(cross);
  }
  constexpr double kFlat = 0.5;  // share of the area that has to face one way
  if (!(glm::length(sum) > kFlat * whole)) return std::nullopt;
  return glm::normalize(sum);
}

}  // namespace

std::optional<Vec3> placeOf(const Scene& scene, LightId id) {
  return std::visit(
      [&](const auto& emitter) -> std::optional<Vec3> {
        if constexpr (requires { emitter.primitive; }) {
          const Box box = bounds(scene[emitter.primitive].shape);
          return box.empty() ? std::nullopt : std::optional<Vec3>(box.center());
        } else if constexpr (requires { emitter.position; }) {
          return emitter.position;
        } else {
          return std::nullopt;
        }
      },
      scene[id].emitter);
}

std::optional<Vec3> aimOf(const Scene& scene, LightId id) {
  const auto& emitter = scene[id].emitter;
  if (const auto* area = std::get_if<AreaLight>(&emitter)) {
    if (const SpotCone* cone = coneOf(scene, *area)) return glm::normalize(cone->direction);
    return normalOf(scene[area->primitive].shape);
  }
  if (const auto* spot = std::get_if<SpotLight>(&emitter)) return spot->direction;
  if (const auto* lambert = std::get_if<LambertPointLight>(&emitter)) return lambert->direction;
  if (const auto* measured = std::get_if<PhotometricLight>(&emitter)) return -measured->frame[2];
  if (const auto* sun = std::get_if<SunLight>(&emitter)) return -sun->direction;
  return std::nullopt;
}

double openingOf(const Scene& scene, LightId id) {
  constexpr double kUnbounded = 90, kNarrowest = 5, kWidest = 150;  // a flat picture of more shows little else
  double angle = kUnbounded;
  if (const auto* area = std::get_if<AreaLight>(&scene[id].emitter)) {
    if (const SpotCone* cone = coneOf(scene, *area)) angle = glm::degrees(cone->fullAngle);
  } else if (const auto* spot = std::get_if<SpotLight>(&scene[id].emitter)) {
    angle = 2 * glm::degrees(std::acos(std::clamp(spot->cosOuter, -1.0, 1.0)));
  }
  return std::clamp(angle, kNarrowest, kWidest);
}

}  // namespace deltalux::viewer
