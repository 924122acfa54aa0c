// Elements that are split together are split as one by one.
#include <gtest/gtest.h>

#include <cstring>

#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "support/rooms.hpp"
#include "support/solved.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Subdivide, ManyTogetherAsOneByOne) {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  test::addBox(scene, grey, Vec3(0), {3, 2, 1.5}, true);
  test::addPolygon(scene, grey, {{0.2, 1, 1}, {0.8, 1, 1}, {0.8, 1, 1.5}});
  test::addShape(scene, grey, Sphere{{1, 0.6, 0.3}, 0.3, false});
  test::addShape(scene, grey, Cylinder{{2, 0.5, 0}, {2, 0.5, 0.5}, 0.2, false});
  Elements one = buildElements(scene, surfaceSides(scene));
  Elements many = buildElements(scene, surfaceSides(scene));
  std::vector<ElementId> parts = one.inputs;
  for (int round = 0; round < 3; ++round) {
    // Some are split already, as callers may find them.
    if (round > 0) parts.push_back(one.inputs[0]);
    std::vector<char> split;
    for (const ElementId e : parts) split.push_back(subdivide(one, scene, e));
    EXPECT_EQ(subdivide(many, scene, parts), split);
    std::vector<ElementId> finer;
    for (const ElementId e : parts)
      for (std::size_t c = 0; c < one.at(e).childCount; c += 1 + c % 2) finer.push_back(one.child(e, c));
    parts = std::move(finer);
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  }
  ASSERT_GT(one.size(), one.inputs.size() * 8);
  EXPECT_EQ(many.key, one.key);
  EXPECT_EQ(many.outlines, one.outlines);
  EXPECT_TRUE(sameBytes(many.domain, one.domain));
  EXPECT_TRUE(sameBytes(many.nodes, one.nodes));
  EXPECT_TRUE(sameBytes(many.moments, one.moments));
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(many.topology[i].parent, one.topology[i].parent);
    EXPECT_EQ(many.topology[i].firstChild, one.topology[i].firstChild);
    EXPECT_EQ(many.geometry[i].area, one.geometry[i].area);
    EXPECT_EQ(many.geometry[i].center, one.geometry[i].center);
    EXPECT_EQ(many.geometry[i].meanFreePath, one.geometry[i].meanFreePath);
  }
}

}  // namespace
}  // namespace deltalux
