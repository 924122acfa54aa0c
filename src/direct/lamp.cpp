#include "direct/lamp.hpp"

#include <algorithm>
#include <cmath>

#include "direct/tuning.hpp"

namespace deltalux::direct {

namespace {

constexpr float kGrazing = 1e-9f;   // in place of a cosine of 0 that is not proven [rounding]
constexpr float kRounding = 1e-5f;  // [rounding]

float sineOf(float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }

}  // namespace

EmissionCone emissionCone(const Vec3& axis, double angle) {
  if (!(angle < kPi)) return {};
  return {Vec3f(axis), static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

EmissionCone emissionCone(const Lamp& lamp) {
  return emissionCone(lamp.axis, lamp.flat ? std::min(lamp.halfAngle, 0.5 * kPi) : lamp.halfAngle);
}

/// [CK18 (union of cones)]
EmissionCone joined(const EmissionCone& a, const EmissionCone& b) {
  if (a.cosine > b.cosine) return joined(b, a);
  if (a.cosine <= -1) return a;
  const double wide = std::atan2(a.sine, a.cosine), narrow = std::atan2(b.sine, b.cosine);
  const double between = std::acos(std::clamp<double>(glm::dot(a.axis, b.axis), -1, 1));
  if (between + narrow <= wide) return a;
  const double angle = 0.5 * (wide + between + narrow);
  const Vec3 around = glm::cross(Vec3(a.axis), Vec3(b.axis));
  if (angle >= kPi || !(glm::length(around) > 1e-6)) return {};
  const Vec3 across = glm::normalize(glm::cross(glm::normalize(around), Vec3(a.axis)));
  const double turn = angle - wide;
  return emissionCone(std::cos(turn) * Vec3(a.axis) + std::sin(turn) * across, angle + kRounding);
}

float greatestCosine(const LampSphere& s, const hierarchy::ElementGeometry& g) {
  const Vec3f d = g.center - s.center;
  // All of the lamps behind the patch's plane.
  if (g.normalCone >= 1 && glm::dot(s.half, glm::abs(g.normal)) - glm::dot(d, g.normal) < 0) return 0;
  const float square = glm::dot(d, d), radius = g.radius + s.radius;
  if (!(square > radius * radius)) return 1;
  const float distance = std::sqrt(square), sine = radius / distance, cosine = sineOf(sine);  // of how wide both are
  // Outside their cones: the angle to the axis exceeds the sum of both.
  if (s.cone.cosine > -cosine &&
      glm::dot(d, s.cone.axis) < distance * (s.cone.cosine * cosine - s.cone.sine * sine - kRounding))
    return 0;
  if (g.normalCone <= -cosine) return 1;
  const float towards = -glm::dot(d, g.normal) / distance;
  const float coneSine = sineOf(g.normalCone), free = g.normalCone * cosine - coneSine * sine;
  if (towards >= free) return 1;
  return std::max(towards * free + sineOf(towards) * sineOf(free), kGrazing);
}

double potential(const Lamp& lamp, const hierarchy::ElementGeometry& g) {
  if (lamp.sun) {
    if (g.normalCone <= -1) return lamp.most;
    const double cone = std::acos(std::clamp<double>(g.normalCone, -1, 1));
    const double away = std::acos(std::clamp(glm::dot(Vec3(g.normal), lamp.axis), -1.0, 1.0));
    const double least = std::max(0.0, away - cone - lamp.halfAngle);
    return least >= 0.5 * kPi ? 0.0 : lamp.most * std::cos(least);
  }
  const Vec3f center = 0.5f * (lamp.lower + lamp.upper), half = 0.5f * (lamp.upper - lamp.lower);
  if (lamp.flat) {  // all of the patch behind the lamp's plane
    const Vec3f c = 0.5f * (g.lower + g.upper), h = 0.5f * (g.upper - g.lower), n(lamp.axis);
    if (glm::dot(c - center, n) + glm::dot(h, glm::abs(n)) + glm::dot(half, glm::abs(n)) < 0) return 0;
  }
  const float size = glm::length(half);
  const float cosine = greatestCosine({center, half, size, lamp.cone}, g);
  if (!(cosine > 0)) return 0;
  const double nearest = std::max<double>(glm::length(g.center - center) - g.radius, 0.5f * (g.radius + size));
  return lamp.most * cosine / std::max(nearest * nearest, 1e-30);
}

bool isBelow(const Lamp& lamp, const Vec3f& at, const Vec3f& normal) {
  if (lamp.sun) return false;
  const Vec3f center = 0.5f * (lamp.lower + lamp.upper), half = 0.5f * (lamp.upper - lamp.lower);
  const Vec3f up = glm::abs(normal), coordinates = glm::abs(center) + half + glm::abs(at);
  return glm::dot(center - at, normal) + glm::dot(half, up) < -kRounding * glm::dot(coordinates, up);
}

bool isNarrow(const Lamp& lamp) { return !lamp.sun && 2 * lamp.beam <= tuning::kNarrow; }

double beamWidth(const Lamp& lamp, const hierarchy::ElementGeometry& g) {
  if (!isNarrow(lamp)) return kInfinity;
  const Vec3 center = 0.5 * (Vec3(lamp.lower) + Vec3(lamp.upper)), d = Vec3(g.center) - center;
  const double distance = glm::length(d), size = glm::length(Vec3(lamp.upper - lamp.lower)), radius = g.radius + size;
  if (distance > radius &&
      std::acos(std::clamp(glm::dot(d, lamp.axis) / distance, -1.0, 1.0)) - std::asin(radius / distance) > lamp.beam)
    return kInfinity;
  return size + 2 * std::max(distance - g.radius, 0.0) * std::tan(lamp.beam);
}

}  // namespace deltalux::direct
