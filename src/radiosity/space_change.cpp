#include "radiosity/space_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltalux {

namespace {

constexpr float kSlack = 1e-5f;  // of the coordinates: boxes are grown by what single precision loses

bool segmentMeets(const Vec3f& lower, const Vec3f& upper, const Ray& ray, float radius = 0.0f) {
  float near = ray.tNear, far = ray.tFar;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(ray.direction[i]) < 1e-12f) {
      if (ray.origin[i] < lower[i] - radius || ray.origin[i] > upper[i] + radius) return false;
      continue;
    }
    const float inverse = 1.0f / ray.direction[i];
    const float a = (lower[i] - radius - ray.origin[i]) * inverse, b = (upper[i] + radius - ray.origin[i]) * inverse;
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

}  // namespace

void SpaceChange::add(const Box& box) {
  if (box.empty()) return;
  const Vec3f size = glm::max(glm::abs(Vec3f(box.lower)), glm::abs(Vec3f(box.upper)));
  const Vec3f slack(kSlack * std::max({size.x, size.y, size.z, 1e-3f}));
  parts_.push_back({Vec3f(box.lower) - slack, Vec3f(box.upper) + slack});
  all_.lower = glm::min(all_.lower, parts_.back().lower);
  all_.upper = glm::max(all_.upper, parts_.back().upper);
}

void SpaceChange::setMoved(std::vector<char> moved, const Elements& elements, const Scene& scene) {
  moved_ = std::move(moved);
  for (std::size_t i = 0; i < moved_.size(); ++i)
    if (moved_[i] && elements.topology[i].depth == 0 && elements.isPatch(ElementId(i)))
      objects_.add(scene, elements.domain[i].primitive);
}

void SpaceChange::add(const SpaceChange& more) {
  objects_.add(more.objects_);
  parts_.insert(parts_.end(), more.parts_.begin(), more.parts_.end());
  all_.lower = glm::min(all_.lower, more.all_.lower);
  all_.upper = glm::max(all_.upper, more.all_.upper);
  moved_.resize(std::max(moved_.size(), more.moved_.size()), 0);
  for (std::size_t i = 0; i < more.moved_.size(); ++i) moved_[i] |= more.moved_[i];
}

float SpaceChange::nearness(const Vec3f& center, float radius) const {
  float most = 0;
  for (const Part& p : parts_) {
    const Vec3f d = center - 0.5f * (p.lower + p.upper), half = 0.5f * (p.upper - p.lower) + radius;
    const float size = glm::dot(half, half);
    most = std::max(most, size / std::max(glm::dot(d, d), size));
  }
  return most;
}

bool SpaceChange::meets(const Shaft& shaft) const {
  if (parts_.empty() || !shaft.meets(all_.lower, all_.upper)) return false;
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& p) { return shaft.meets(p.lower, p.upper); });
}

bool SpaceChange::meets(const Ray& ray) const {
  if (parts_.empty() || !segmentMeets(all_.lower, all_.upper, ray)) return false;
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& p) { return segmentMeets(p.lower, p.upper, ray); });
}

bool SpaceChange::meets(const Vec3f& lower, const Vec3f& upper) const {
  const auto overlap = [&](const Part& p) {
    return glm::all(glm::lessThanEqual(p.lower, upper)) && glm::all(glm::lessThanEqual(lower, p.upper));
  };
  return overlap(all_) && std::any_of(parts_.begin(), parts_.end(), overlap);
}

bool SpaceChange::meets(const Vec3f& a, float radiusA, const Vec3f& b, float radiusB) const {
  // The hull lies within the larger radius of the axis: the axis must meet a box that is larger by that.
  return meets(Ray{a, 0.0f, b - a, 1.0f}, std::max(radiusA, radiusB));
}

bool SpaceChange::meets(const Ray& axis, float radius) const {
  if (parts_.empty() || !segmentMeets(all_.lower, all_.upper, axis, radius)) return false;
  return parts_.size() == 1 || std::any_of(parts_.begin(), parts_.end(),
                                           [&](const Part& p) { return segmentMeets(p.lower, p.upper, axis, radius); });
}

bool SpaceChange::within(const Box& box) const {
  return glm::all(glm::lessThanEqual(Vec3f(box.lower), all_.lower)) &&
         glm::all(glm::lessThanEqual(all_.upper, Vec3f(box.upper)));
}

bool SpaceChange::behind(const Vec3f& point, const Vec3f& normal) const {
  if (parts_.empty()) return false;
  const Vec3f middle = 0.5f * (all_.lower + all_.upper), half = 0.5f * (all_.upper - all_.lower);
  return glm::dot(middle - point, normal) + glm::dot(half, glm::abs(normal)) < 0;
}

void SpaceChange::meetsRays(const ElementGeometry& from, std::span<const RayCode> rays,
                            std::vector<std::uint32_t>& out) const {
  if (parts_.empty()) return;
  constexpr float kLeast = 1e-6f;  // of a coordinate of a direction
  constexpr std::size_t kMost = 64;
  // As far as a ray of the box, or one whose direction is not quite the coded one, may be from that of its middle.
  const Vec3f center = 0.5f * (from.lower + from.upper), half = 0.5f * (from.upper - from.lower);
  const Vec3f far = glm::max(glm::abs(all_.lower - center), glm::abs(all_.upper - center));
  const Vec3f grown = half + 1.05f * kDirectionCodeError * glm::length(far + half);
  const Vec3f lower = all_.lower - grown - center, upper = all_.upper + grown - center;
  std::array<std::uint8_t, kMost> meets;
  for (std::size_t begin = 0; begin < rays.size(); begin += kMost) {
    const std::size_t count = std::min(kMost, rays.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t bits = rays[begin + i].bits;
      const RayCode ray{bits};
      const Vec3f d = direction(towards(ray));
      float nearest = (blocked(ray) ? 1 - kRayCodeError : 0.0f) * end(ray);
      float furthest = (1 + kRayCodeError) * end(ray);
      for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1.0f / std::copysign(std::max(std::abs(d[axis]), kLeast), d[axis]);
        const float a = lower[axis] * inverse, b = upper[axis] * inverse;
        nearest = std::max(nearest, std::min(a, b));
        furthest = std::min(furthest, std::max(a, b));
      }
      meets[i] = nearest <= furthest;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (meets[i]) out.push_back(static_cast<std::uint32_t>(begin + i));
  }
}

bool SpaceChange::meetsBeam(const Vec3f& center, float radius, const Vec3f& direction, float angle) const {
  if (parts_.empty()) return false;
  if (angle > 1.0f) return true;
  // As wide as the beam is where the boxes end; the tangent from above.
  const float furthest = glm::length(glm::max(glm::abs(all_.lower - center), glm::abs(all_.upper - center)));
  const float wide = radius + furthest * angle / (1.0f - 0.36f * angle * angle);
  return meets(Ray{center, 0.0f, direction, furthest + radius}, wide);
}

}  // namespace deltalux
