#include "meter_rectangle.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kLevel = 0.999;    // cosine of a normal to the vertical, above which a surface is level
constexpr double kNoExtent = 1e-6;  // shorter side of a rectangle, of its diagonal, that is none
}  // namespace

std::optional<MeterField> fieldBetween(const SurfaceHit& corner, const Vec3& opposite, const Vec3& up) {
  const Vec3 n = corner.normal;
  const bool level = std::abs(glm::dot(n, up)) > kLevel;
  // On a level surface the first side follows a scene axis that is level, too.
  Vec3 u = level ? (std::abs(up.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)) : glm::cross(up, n);
  u = glm::normalize(u - glm::dot(u, n) * n);
  const Vec3 v = glm::cross(n, u), diagonal = opposite - corner.position;
  MeterField field;
  field.corner = corner.position, field.normal = n;
  field.across = glm::dot(diagonal, u) * u, field.along = glm::dot(diagonal, v) * v;
  const double shorter = std::min(glm::length(field.across), glm::length(field.along));
  if (shorter <= kNoExtent * glm::length(diagonal)) return std::nullopt;
  return field;
}

}  // namespace deltalux::viewer
