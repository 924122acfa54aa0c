#include "radiosity/space_change.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux {

namespace {

constexpr float kSlack = 1e-5f;  // of the coordinates: boxes are grown by what single precision loses

bool segmentMeets(const Vec3f& lower, const Vec3f& upper, const Ray& ray) {
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

}  // namespace

void SpaceChange::add(const Box& box) {
  if (box.empty()) return;
  const Vec3f size = glm::max(glm::abs(Vec3f(box.lower)), glm::abs(Vec3f(box.upper)));
  const Vec3f slack(kSlack * std::max({size.x, size.y, size.z, 1e-3f}));
  parts_.push_back({Vec3f(box.lower) - slack, Vec3f(box.upper) + slack});
  all_.lower = glm::min(all_.lower, parts_.back().lower);
  all_.upper = glm::max(all_.upper, parts_.back().upper);
}

void SpaceChange::add(const SpaceChange& more) {
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
  if (parts_.empty()) return false;
  // The hull lies within the larger radius of the axis, and the box within its half diagonal of its centre.
  const Vec3f center = 0.5f * (all_.lower + all_.upper), d = b - a;
  const float reach = 0.5f * glm::length(all_.upper - all_.lower) + std::max(radiusA, radiusB);
  const float squared = glm::dot(d, d);
  const float t = squared > 0 ? std::clamp(glm::dot(center - a, d) / squared, 0.0f, 1.0f) : 0.0f;
  const Vec3f off = center - (a + t * d);
  return glm::dot(off, off) <= reach * reach;
}

bool SpaceChange::meetsBeam(const Vec3f& center, float radius, const Vec3f& direction, float angle) const {
  if (parts_.empty()) return false;
  const Vec3f middle = 0.5f * (all_.lower + all_.upper), d = middle - center;
  const float reach = 0.5f * glm::length(all_.upper - all_.lower) + radius;
  const float along = glm::dot(d, direction), squared = glm::dot(d, d);
  if (squared <= reach * reach || angle > 1.0f) return true;
  // Seen from the ball's centre: the angle to the middle, against that of the beam and that under which both balls
  // show.
  const float length = std::sqrt(squared);
  const float between = std::acos(std::clamp(along / length, -1.0f, 1.0f));
  return between <= angle + std::asin(std::min(1.0f, reach / length));
}

}  // namespace deltalux
