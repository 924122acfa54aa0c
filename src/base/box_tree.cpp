#include "base/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace deltalux {

namespace {
constexpr std::uint32_t kLeafBoxes = 4;  // [task]
}

BoxTree::BoxTree(std::vector<BoxF> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (boxes_.empty()) return;
  nodes_.reserve(boxes_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(boxes_.size()));
}

void BoxTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  BoxF box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    const BoxF& b = boxes_[order_[i]];
    box.extend(b);
    centers.extend(b.lower + b.upper);
  }
  nodes_[node].box = box;
  if (end - begin <= kLeafBoxes) {
    nodes_[node].first = begin, nodes_[node].count = end - begin;
    return;
  }
  const Vec3f spread = centers.upper - centers.lower;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  const std::uint32_t middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float ca = boxes_[a].lower[axis] + boxes_[a].upper[axis];
                     const float cb = boxes_[b].lower[axis] + boxes_[b].upper[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = first;
  nodes_.emplace_back();
  nodes_.emplace_back();
  split(first, begin, middle);
  split(first + 1, middle, end);
}

}  // namespace deltalux
