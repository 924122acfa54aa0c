#include "change/moved_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/few_boxes.hpp"
#include "base/tuning.hpp"
#include "change/separating_axes.hpp"

namespace deltalux::change {

namespace {

constexpr double kMargin = 1e-5;  // that boxes are wider by, in the scene's extent: roundings of origins [rounding]

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

struct Extent {
  Vec3f middle, half;
};

/// Which holds the box, whatever is rounded.
Extent extentOf(const BoxF& box) {
  const Vec3f middle = 0.5f * (box.lower + box.upper);
  return {middle, glm::max(box.upper - middle, middle - box.lower)};
}

float surface(const BoxF& box) {
  const Vec3f d = box.upper - box.lower;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

BoxF hull(std::span<const BoxF> boxes) {
  BoxF all;
  for (const BoxF& box : boxes) all.extend(box);
  return all;
}

/// Boxes that hold all of these, some kBoxes: the largest is split, at the middle of its boxes.
std::vector<BoxF> fewBoxes(std::vector<BoxF> boxes) {
  struct Group {
    std::size_t begin, end;
    BoxF box;
  };
  const auto groupOf = [&](std::size_t begin, std::size_t end) {
    return Group{begin, end, hull(std::span(boxes).subspan(begin, end - begin))};
  };
  if (boxes.empty()) return {};
  std::vector<Group> groups{groupOf(0, boxes.size())};
  while (groups.size() < kFewBoxes) {
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
  before = fewBoxes(std::move(before)), after = fewBoxes(std::move(after));
  for (std::vector<BoxF>* boxes : {&before, &after})
    for (BoxF& box : *boxes) box.lower -= margin_, box.upper += margin_;
  // What meets one box around both is looked for in both: worth while where that is no larger than two.
  BoxF both = hull(before);
  both.extend(hull(after));
  if (before.empty() || after.empty() || surface(both) <= surface(hull(before)) + surface(hull(after)))
    before.insert(before.end(), after.begin(), after.end()), after.clear();
  hold(before), hold(after);
}

void MovedSpace::hold(std::span<const BoxF> group) {
  if (group.empty()) return;
  around_.emplace_back(), rows_.emplace_back();
  for (const BoxF& box : group) put(box);
}

void MovedSpace::put(const BoxF& box) {
  boxes_.push_back(box), around_.back().extend(box), all_.extend(box);
  Rows& rows = rows_.back();
  if (rows.empty() || rows.back().count == Row::kBoxes) rows.emplace_back();
  rows.back().put(box);
}

void MovedSpace::add(PrimitiveId primitive, const BoxF& box) {
  moved_[primitive.index()] = 1;
  if (!std::exchange(added_, true)) around_.emplace_back(), rows_.emplace_back();
  put({box.lower - margin_, box.upper + margin_});
}

void MovedSpace::Row::put(const BoxF& box) {
  const auto [middle, half] = extentOf(box);
  for (std::size_t i = count; i < kBoxes; ++i) {
    x[i] = middle.x, y[i] = middle.y, z[i] = middle.z;
    halfX[i] = half.x, halfY[i] = half.y, halfZ[i] = half.z;
  }
  ++count;
}

bool MovedSpace::Line::misses(float x, float y, float z, float halfX, float halfY, float halfZ) const {
  const float cx = x - from.x, cy = y - from.y, cz = z - from.z;
  const float hx = halfX + half.x, hy = halfY + half.y, hz = halfZ + half.z;
  const float fx = std::abs(cx) + hx, fy = std::abs(cy) + hy, fz = std::abs(cz) + hz;
  // As wide as the line may have strayed where it is farthest in the box, and no longer.
  const float far = std::sqrt(fx * fx + fy * fy + fz * fz), t = length < far ? length : far;
  const float strayed = stray * t;
  return apart(cx, cy, cz, hx + strayed, hy + strayed, hz + strayed, t * halfUnit.x, t * halfUnit.y, t * halfUnit.z) >
         0;
}

bool MovedSpace::Line::misses(const BoxF& box) const {
  const auto [at, size] = extentOf(box);
  return misses(at.x, at.y, at.z, size.x, size.y, size.z);
}

bool MovedSpace::Row::crosses(const Line& line) const {
  const Line own = line;  // which nothing else can write to
  int any = 0;
  for (std::size_t i = 0; i < kBoxes; ++i) any |= own.misses(x[i], y[i], z[i], halfX[i], halfY[i], halfZ[i]) ? 0 : 1;
  return any != 0;
}

bool MovedSpace::behind(const Vec3f& point, const Vec3f& normal) const {
  const Vec3f center = 0.5f * (all_.lower + all_.upper), half = 0.5f * (all_.upper - all_.lower);
  return boxes_.empty() || glm::dot(normal, center - point) + glm::dot(glm::abs(normal), half) < 0;
}

bool MovedSpace::touches(const BoxF& box) const {
  return all_.overlaps(box) && std::ranges::any_of(boxes_, [&](const BoxF& moved) { return moved.overlaps(box); });
}

bool MovedSpace::crosses(const BoxF& from, const Vec3f& direction, float length, float stray) const {
  const Line line{0.5f * (from.lower + from.upper), 0.5f * (from.upper - from.lower),
                  0.5f / glm::length(direction) * direction, length, stray};
  for (std::size_t group = 0; group < rows_.size(); ++group)
    if (!line.misses(around_[group]) &&
        std::ranges::any_of(rows_[group], [&](const Row& row) { return row.crosses(line); }))
      return true;
  return false;
}

bool MovedSpace::between(const BoxF& a, const BoxF& b) const {
  BoxF both = a;
  both.extend(b);
  // On the way the box that holds all segments' points grows from one to the other.
  const auto passes = [&](const BoxF& box) {
    if (!both.overlaps(box)) return false;
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
