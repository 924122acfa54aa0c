#include "base/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.hpp"

namespace deltalux {

namespace {

std::vector<BoxF> someBoxes(std::size_t count) {
  Rng random(7);
  const auto point = [&] {
    Vec3f p;
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(random.uniform());
    return p;
  };
  std::vector<BoxF> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f lower = point();
    boxes.push_back({lower, lower + 0.2f * point()});
  }
  return boxes;
}

std::vector<std::uint32_t> overlappingOneByOne(const std::vector<BoxF>& boxes, const BoxF& box) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].overlaps(box)) found.push_back(i);
  return found;
}

TEST(BoxTree, FindsWhatOverlaps) {
  const std::vector<BoxF> boxes = someBoxes(300);
  const BoxTree tree(boxes);
  for (const BoxF& box : boxes) {
    std::vector<std::uint32_t> found;
    tree.overlapping(box, [&](std::uint32_t i) { found.push_back(i); });
    std::ranges::sort(found);
    EXPECT_EQ(found, overlappingOneByOne(boxes, box));
  }
}

TEST(BoxTree, AsksNoFurtherThanToTheFirst) {
  const std::vector<BoxF> boxes = someBoxes(300);
  const BoxTree tree(boxes);
  const BoxF everywhere{Vec3f(0.0f), Vec3f(2.0f)};
  int asked = 0;
  EXPECT_TRUE(tree.anyOverlapping(everywhere, [&](std::uint32_t) { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_FALSE(tree.anyOverlapping(everywhere, [&](std::uint32_t) { return ++asked, false; }));
  EXPECT_EQ(asked, 3 + 300);
}

TEST(BoxTree, OfNothingHasNothing) {
  EXPECT_FALSE(BoxTree({}).anyOverlapping({Vec3f(-1.0f), Vec3f(1.0f)}, [](std::uint32_t) { return true; }));
}

}  // namespace

}  // namespace deltalux
