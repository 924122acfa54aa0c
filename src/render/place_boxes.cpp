#include "render/place_boxes.hpp"

#include <algorithm>
#include <span>

namespace deltalux::rendering {

namespace {

struct BoxGroup {
  std::span<Box> boxes;
  Box all;

  explicit BoxGroup(std::span<Box> of) : boxes(of) {
    for (const Box& b : boxes) all.extend(b);
  }
  double width() const { return boxes.size() > 1 ? all.diagonal() : -1.0; }
};

int longestAxis(const Box& box) {
  const Vec3 size = box.extent();
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

std::vector<Box> coveringBoxes(std::vector<Box> boxes, std::size_t most) {
  if (boxes.size() <= most) return boxes;
  std::vector<BoxGroup> groups{BoxGroup(boxes)};
  while (groups.size() < most) {
    const auto widest = std::max_element(groups.begin(), groups.end(),
                                         [](const BoxGroup& a, const BoxGroup& b) { return a.width() < b.width(); });
    const std::span<Box> all = widest->boxes;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end(), [axis = longestAxis(widest->all)](const Box& a, const Box& b) {
      return a.center()[axis] < b.center()[axis];
    });
    *widest = BoxGroup(all.first(all.size() / 2));
    groups.emplace_back(all.subspan(all.size() / 2));
  }
  std::vector<Box> covering;
  for (const BoxGroup& g : groups) covering.push_back(g.all);
  return covering;
}

}  // namespace deltalux::rendering
