#pragma once
// A bounding-volume hierarchy over boxes that answers which of them overlap a given box. Median splits, fixed once
// built. Cost: O(n log n) to build, O(log n + hits) a query in practice.
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux {

struct BoxF {
  Vec3f lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

  void extend(const Vec3f& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void extend(const BoxF& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  bool overlaps(const BoxF& b) const {
    return glm::all(glm::lessThanEqual(lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, upper));
  }
};

class BoxTree {
 public:
  explicit BoxTree(std::vector<BoxF> boxes);

  /// visit(index) for every box that overlaps `box`, in an order that depends on the boxes alone.
  template <class Visit>
  void overlapping(const BoxF& box, const Visit& visit) const {
    anyOverlapping(box, [&](std::uint32_t i) { return visit(i), false; });
  }
  /// Whether test(index) holds for any box that overlaps `box`; asks no further then.
  template <class Test>
  bool anyOverlapping(const BoxF& box, const Test& test) const {
    if (nodes_.empty()) return false;
    std::uint32_t stack[64];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!node.box.overlaps(box)) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (boxes_[order_[i]].overlaps(box) && test(order_[i])) return true;
    }
    return false;
  }

 private:
  struct Node {
    BoxF box;
    std::uint32_t first = 0, count = 0;  // children first, first + 1 when count is 0; else a range of order_
  };
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<BoxF> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace deltalux
