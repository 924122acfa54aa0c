#include "paper/space_change.hpp"

#include <algorithm>
#include <cmath>

#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"

namespace deltalux::paper {

namespace {

constexpr float kBoxSlack = 1e-5f;  // of the coordinates: boxes are grown by what single precision loses [rounding]

bool segmentMeets(const Vec3f& lower, const Vec3f& upper, const tracing::Ray& ray) {
  float near = ray.tNear, far = ray.tFar;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(ray.direction[i]) < 1e-12f) {
      if (ray.origin[i] < lower[i] || ray.origin[i] > upper[i]) return false;
      continue;
    }
    const float inverse = 1.0f / ray.direction[i];
    const float a = (lower[i] - ray.origin[i]) * inverse, b = (upper[i] - ray.origin[i]) * inverse;
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

/// Whether balls along a segment that begins at its origin, whose radius goes evenly from one to another, may meet a
/// box. The centres of those that do lie where the segment meets the box as it is larger by their largest radius: no
/// others count, and they may be smaller.
bool ballsMeet(const Vec3f& lower, const Vec3f& upper, const tracing::Ray& axis, float from, float to) {
  constexpr float kWorth = 0.8f, kOutward = 1.0001f, kSmallest = 1e-12f;  // [rounding]
  Vec3f enter, leave, scale;
  for (int i = 0; i < 3; ++i) {
    const float d = axis.direction[i], inverse = 1.0f / std::copysign(std::max(std::abs(d), kSmallest), d);
    const float a = (lower[i] - axis.origin[i]) * inverse, b = (upper[i] - axis.origin[i]) * inverse;
    enter[i] = std::min(a, b), leave[i] = std::max(a, b), scale[i] = std::abs(inverse);
  }
  float near = 0, far = axis.tFar;
  const auto meets = [&](float radius) {
    for (int i = 0; i < 3; ++i) {
      near = std::max(near, enter[i] - radius * scale[i]);
      far = std::min(far, leave[i] + radius * scale[i]);
    }
    return near <= far;
  };
  const float radius = std::max(from, to);
  if (!meets(radius)) return false;
  const float slope = (to - from) / axis.tFar, within = kOutward * (from + slope * (slope > 0 ? far : near));
  return within > kWorth * radius || meets(within);
}

constexpr float kWidest =
    1.0f;  // angle of a beam, in radians, as far as tangent() is one: wider ones meet all [defined]

float tangent(float angle) { return angle / (1.0f - 0.36f * angle * angle); }  // from above

}  // namespace

void SpaceChange::add(const Box& box) {
  if (box.empty()) return;
  const Vec3f size = glm::max(glm::abs(Vec3f(box.lower)), glm::abs(Vec3f(box.upper)));
  const Vec3f slack(kBoxSlack * std::max({size.x, size.y, size.z, 1e-3f}));
  parts_.add({Vec3f(box.lower) - slack, Vec3f(box.upper) + slack});
  hidden_.reset();
}

void SpaceChange::addMoved(std::span<const hierarchy::ElementId> inputs, const hierarchy::Elements& elements) {
  moved_.grow(elements.size());
  for (const hierarchy::ElementId input : inputs)
    hierarchy::forEachBelow(elements, input, [&](hierarchy::ElementId e) { return moved_.at(e.index()) = 1; });
  inputs_.insert(inputs_.end(), inputs.begin(), inputs.end());
  hidden_.reset();
  sortUnique(inputs_);
}

void SpaceChange::findHidden(const hierarchy::Elements& elements, const Scene& scene) {
  hidden_.reset();
  Box region{Vec3(parts_.all().lower), Vec3(parts_.all().upper)};
  for (const hierarchy::ElementId input : inputs_) {
    if (elements.isDistant(input)) return;
    const hierarchy::ElementGeometry& g = elements.shape(input);
    if (g.area > 0) region.extend(Box{Vec3(g.lower), Vec3(g.upper)});
  }
  if (!parts_.empty()) hidden_ = std::make_shared<OutOfSight>(elements, scene, region);
}

bool SpaceChange::meets(const Shaft& shaft) const {
  return parts_.any([&](const Vec3f& lower, const Vec3f& upper) { return shaft.meets(lower, upper); });
}

bool SpaceChange::meets(const tracing::Ray& ray) const {
  return parts_.any([&](const Vec3f& lower, const Vec3f& upper) { return segmentMeets(lower, upper, ray); });
}

bool SpaceChange::meets(const Vec3f& a, float radiusA, const Vec3f& b, float radiusB) const {
  const tracing::Ray axis{a, 0.0f, b - a, 1.0f};
  return parts_.any(
      [&](const Vec3f& lower, const Vec3f& upper) { return ballsMeet(lower, upper, axis, radiusA, radiusB); });
}

std::optional<double> SpaceChange::seenFrom(const Vec3f& center, float radius, Vec3& axis) const {
  const Vec3 d = 0.5 * (Vec3(parts_.all().lower) + Vec3(parts_.all().upper)) - Vec3(center);
  const double distance = glm::length(d),
               size = 0.5 * glm::length(Vec3(parts_.all().upper) - Vec3(parts_.all().lower)) + radius;
  if (empty() || !(size < std::sin(kWidest) * distance)) return std::nullopt;
  axis = d / distance;
  return std::asin(size / distance);
}

bool SpaceChange::meetsBeam(const hierarchy::ElementGeometry& from, const Vec3f& direction, float angle) const {
  if (empty()) return false;
  if (angle > kWidest) return true;
  const Vec3f center = 0.5f * (from.lower + from.upper), half = 0.5f * (from.upper - from.lower);
  const float end = angle > 0 ? furthest(center) + glm::length(half) : std::numeric_limits<float>::max();
  return ballsMeet(parts_.all().lower - half, parts_.all().upper + half, tracing::Ray{center, 0.0f, direction, end},
                   0.0f, angle > 0 ? end * tangent(angle) : 0.0f);
}

/// How far the boxes reach from a point.
float SpaceChange::furthest(const Vec3f& from) const {
  return glm::length(glm::max(glm::abs(parts_.all().lower - from), glm::abs(parts_.all().upper - from)));
}

}  // namespace deltalux::paper
