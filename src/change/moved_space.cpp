#include "change/moved_space.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace deltalux::change {

namespace {

constexpr double kMargin = 1e-5;  // that boxes are wider by, in shares of the scene's extent: roundings of origins

float distanceTo(const BoxF& box, const Vec3f& p) {
  return glm::length(glm::max(glm::max(box.lower - p, p - box.upper), Vec3f(0.0f)));
}

/// Of the parameters in [begin, end] at which a line is within the slab; none where begin > end then.
void clip(float lower, float upper, float origin, float direction, float& begin, float& end) {
  if (direction == 0) {
    if (origin < lower || origin > upper) end = -1;
    return;
  }
  float near = (lower - origin) / direction, far = (upper - origin) / direction;
  if (near > far) std::swap(near, far);
  begin = std::max(begin, near), end = std::min(end, far);
}

}  // namespace

MovedSpace::MovedSpace(const Scene& scene, std::span<const SceneChange::Moved> all) {
  moved_.resize(scene.primitives.size(), 0);
  std::map<std::uint32_t, std::pair<Box, Box>> objects;
  Box extent;
  for (const Primitive& p : scene.primitives) extent.extend(bounds(p.shape));
  for (const SceneChange::Moved& m : all) {
    if (m.primitive.index() < moved_.size()) moved_[m.primitive.index()] = 1;
    auto& [before, after] = objects[scene[m.primitive].object.value];
    if (!m.before.empty()) before.extend(m.before), extent.extend(m.before);
    if (!m.after.empty()) after.extend(m.after);
    if (const Box now = bounds(scene[m.primitive].shape); !now.empty()) after.extend(now);
  }
  margin_ = static_cast<float>(kMargin * extent.diagonal());
  for (const auto& [object, boxes] : objects)
    for (const Box& box : {boxes.first, boxes.second})
      if (!box.empty()) boxes_.push_back({Vec3f(box.lower) - margin_, Vec3f(box.upper) + margin_});
}

void MovedSpace::add(PrimitiveId primitive, const BoxF& box) {
  moved_[primitive.index()] = 1;
  boxes_.push_back({box.lower - margin_, box.upper + margin_});
}

bool MovedSpace::touches(const Vec3f& point, float radius) const {
  return std::ranges::any_of(boxes_, [&](const BoxF& box) { return distanceTo(box, point) <= radius; });
}

bool MovedSpace::crosses(const Vec3f& point, float radius, const Vec3f& direction, float length, float stray) const {
  const float unit = glm::length(direction);
  return std::ranges::any_of(boxes_, [&](const BoxF& box) {
    // As wide as the line may have strayed where it is farthest in the box.
    const float far = std::min(length, glm::length(glm::max(glm::abs(box.lower - point), glm::abs(box.upper - point))));
    const float wide = radius + stray * far;
    float begin = 0, end = (length + wide) / unit;
    for (int axis = 0; axis < 3; ++axis)
      clip(box.lower[axis] - wide, box.upper[axis] + wide, point[axis], direction[axis], begin, end);
    return begin <= end;
  });
}

bool MovedSpace::between(const Vec3f& point, float radius, const BoxF& target) const {
  const Vec3f center = 0.5f * (target.lower + target.upper), half = 0.5f * (target.upper - target.lower);
  const Vec3f way = center - point;
  return std::ranges::any_of(boxes_, [&](const BoxF& box) {
    float begin = 0, end = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const float wide = std::max(radius, half[axis]);
      clip(box.lower[axis] - wide, box.upper[axis] + wide, point[axis], way[axis], begin, end);
    }
    return begin <= end;
  });
}

}  // namespace deltalux::change
