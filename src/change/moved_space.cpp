#include "change/moved_space.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"

namespace deltalux::change {

namespace {

constexpr double kMargin = 1e-5;  // that boxes are wider by, in the scene's extent: roundings of origins [rounding]

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

/// Of the parameters in [begin, end] those at which what goes from `atZero` to `atOne` is not above zero.
void keepBelow(float atZero, float atOne, float& begin, float& end) {
  if (atZero > 0 && atOne > 0) end = -1;
  if (atZero <= 0 && atOne <= 0) return;
  const float zero = atZero / (atZero - atOne);
  if (atZero > 0)
    begin = std::max(begin, zero);
  else
    end = std::min(end, zero);
}

float surface(const BoxF& box) {
  const Vec3f d = box.upper - box.lower;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// Boxes that hold all of these, some kBoxes: the largest is split, at the middle of its boxes.
std::vector<BoxF> fewBoxes(std::vector<BoxF> boxes) {
  struct Group {
    std::size_t begin, end;
    BoxF box;
  };
  const auto groupOf = [&](std::size_t begin, std::size_t end) {
    Group g{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) g.box.extend(boxes[i]);
    return g;
  };
  if (boxes.empty()) return {};
  std::vector<Group> groups{groupOf(0, boxes.size())};
  while (groups.size() < tuning::kBoxes) {
    const auto largest = std::ranges::max_element(
        groups, {}, [](const Group& g) { return g.end - g.begin > 1 ? surface(g.box) : -1.0f; });
    const Group g = *largest;
    if (g.end - g.begin < 2) break;
    const Vec3f d = g.box.upper - g.box.lower;
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const std::size_t middle = (g.begin + g.end) / 2;
    const auto at = [&](std::size_t i) { return boxes.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(g.begin), at(middle), at(g.end), [axis](const BoxF& a, const BoxF& b) {
      return a.lower[axis] + a.upper[axis] < b.lower[axis] + b.upper[axis];
    });
    *largest = groupOf(g.begin, middle);
    groups.push_back(groupOf(middle, g.end));
  }
  std::vector<BoxF> few;
  for (const Group& g : groups) few.push_back(g.box);
  return few;
}

}  // namespace

MovedSpace::MovedSpace(const Scene& scene, std::span<const SceneChange::Moved> all) {
  moved_.resize(scene.primitives.size(), 0);
  std::vector<BoxF> before, after;
  Box extent;
  for (const Primitive& p : scene.primitives) extent.extend(bounds(p.shape));
  const auto add = [&](std::vector<BoxF>& to, const Box& box) {
    if (!box.empty()) to.push_back({Vec3f(box.lower), Vec3f(box.upper)}), extent.extend(box);
  };
  for (const SceneChange::Moved& m : all) {
    if (m.primitive.index() < moved_.size()) moved_[m.primitive.index()] = 1;
    add(before, m.before), add(after, m.after);
    add(after, bounds(scene[m.primitive].shape));
  }
  margin_ = static_cast<float>(kMargin * extent.diagonal());
  for (std::vector<BoxF>* boxes : {&before, &after})
    for (const BoxF& box : fewBoxes(*boxes)) hold({box.lower - margin_, box.upper + margin_});
}

void MovedSpace::hold(const BoxF& box) { boxes_.push_back(box), all_.extend(box); }

void MovedSpace::add(PrimitiveId primitive, const BoxF& box) {
  moved_[primitive.index()] = 1;
  hold({box.lower - margin_, box.upper + margin_});
}

bool MovedSpace::behind(const Vec3f& point, const Vec3f& normal) const {
  const Vec3f center = 0.5f * (all_.lower + all_.upper), half = 0.5f * (all_.upper - all_.lower);
  return boxes_.empty() || glm::dot(normal, center - point) + glm::dot(glm::abs(normal), half) < 0;
}

bool MovedSpace::touches(const BoxF& box) const {
  return std::ranges::any_of(boxes_, [&](const BoxF& moved) { return moved.overlaps(box); });
}

bool MovedSpace::crosses(const BoxF& from, const Vec3f& direction, float length, float stray) const {
  const float unit = glm::length(direction);
  const Vec3f point = 0.5f * (from.lower + from.upper), half = 0.5f * (from.upper - from.lower);
  const auto crosses = [&](const BoxF& box) {
    // As wide as the line may have strayed where it is farthest in the box.
    const float far = std::min(length, glm::length(glm::max(glm::abs(box.lower - point), glm::abs(box.upper - point))));
    const Vec3f wide = half + stray * far;
    float begin = 0, end = (length + glm::length(wide)) / unit;
    for (int axis = 0; axis < 3; ++axis)
      clip(box.lower[axis] - wide[axis], box.upper[axis] + wide[axis], point[axis], direction[axis], begin, end);
    return begin <= end;
  };
  return !boxes_.empty() && crosses(all_) && std::ranges::any_of(boxes_, crosses);
}

bool MovedSpace::between(const BoxF& a, const BoxF& b) const {
  // On the way the box that holds all segments' points grows from one to the other.
  const auto passes = [&](const BoxF& box) {
    float begin = 0, end = 1;
    for (int axis = 0; axis < 3 && begin <= end; ++axis) {
      keepBelow(a.lower[axis] - box.upper[axis], b.lower[axis] - box.upper[axis], begin, end);
      keepBelow(box.lower[axis] - a.upper[axis], box.lower[axis] - b.upper[axis], begin, end);
    }
    return begin <= end;
  };
  return !boxes_.empty() && passes(all_) && std::ranges::any_of(boxes_, passes);
}

}  // namespace deltalux::change
