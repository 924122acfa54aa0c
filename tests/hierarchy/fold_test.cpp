// A mesh that is folded and made again where it is becomes the mesh there would be, to the last bit.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cstring>
#include <map>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/fold.hpp"
#include "hierarchy/patch.hpp"
#include "support/fine_meshes.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

constexpr std::uint32_t kNone = Id<void>::kNone;

template <class T>
bool sameBytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Flat surfaces, some with outlines, curved ones, and one of many faces.
Scene shapes() {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  test::addBox(scene, grey, Vec3(0), {3, 2, 1.5}, true);
  test::addPolygon(scene, grey, {{0.2, 1, 1}, {0.8, 1, 1}, {0.8, 1, 1.5}, {0.5, 1, 1.1}});
  test::addShape(scene, grey, Sphere{{1, 0.6, 0.3}, 0.3, false});
  test::addShape(scene, grey, Cylinder{{2, 0.5, 0}, {2, 0.5, 0.5}, 0.2, false});
  test::addShape(scene, grey, Cone{{2.5, 1.2, 0}, {2.5, 1.2, 0.6}, 0.3, 0.1, true});
  test::addShape(scene, grey, Ring{{1.5, 1, 1.4}, {0, 0, -1}, 0.1, 0.3});
  test::addShape(scene, grey, test::ball({0.7, 1.5, 0.5}, 0.25, 20));
  return scene;
}

Elements inputLevel(const Scene& scene) {
  std::vector<FaceOrder> orders = faceOrders(scene);
  const std::vector<SurfaceSide> sides = surfaceSides(scene, orders);
  return buildElements(scene, sides, std::move(orders));
}

/// Splits patches level by level, those of each that `chooses(key)`.
template <class Chooses>
void refine(Elements& elements, const Scene& scene, int levels, const Chooses& chooses) {
  std::vector<ElementId> parts;
  for (const ElementId e : elements.inputs)
    if (elements.receives(e)) parts.push_back(e);
  for (int level = 0; level < levels; ++level) {
    std::erase_if(parts, [&](ElementId e) { return !chooses(elements.key[e.index()]); });
    const std::vector<char> split = subdivide(elements, scene, parts);
    std::vector<ElementId> finer;
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t c = 0; split[i] && c < elements.at(parts[i]).childCount; ++c)
        finer.push_back(elements.child(parts[i], c));
    parts = std::move(finer);
  }
}

auto threeOfFour(std::uint64_t seed) {
  return [seed](std::uint64_t key) { return combineKeys(key, seed) % 4 != 0; };
}

/// Leaves that receive light, by key.
std::map<std::uint64_t, std::size_t> leavesOf(const Elements& elements) {
  std::map<std::uint64_t, std::size_t> all;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.isReceivingLeaf(ElementId(i))) all[elements.key[i]] = i;
  return all;
}

/// The same patches down to the leaves, to the last bit, in whatever order; in `a` as if just split.
void expectSame(const Elements& a, const Elements& b) {
  const auto as = leavesOf(a), bs = leavesOf(b);
  ASSERT_EQ(as.size(), bs.size());
  for (const auto& [key, j] : bs) {
    ASSERT_TRUE(as.contains(key));
    ElementId x(as.at(key)), y(j);
    for (; y.valid() && b.isPatch(y); x = a.at(x).parent, y = b.at(y).parent) {
      ASSERT_TRUE(x.valid());
      const std::size_t i = x.index(), k = y.index();
      ASSERT_EQ(a.key[i], b.key[k]);
      ASSERT_TRUE(a.at(x).front == b.at(y).front && a.at(x).flat == b.at(y).flat && a.at(x).depth == b.at(y).depth &&
                  a.at(x).childCount == b.at(y).childCount && a.at(x).kind == b.at(y).kind);
      ElementGeometry g = a.geometry[i];
      g.meanFreePath = b.geometry[k].meanFreePath;
      ASSERT_TRUE(sameBytes(g, b.geometry[k]));
      ASSERT_TRUE(sameBytes(a.nodes[i], b.nodes[k]));
      ASSERT_TRUE(sameBytes(a.moments[i], b.moments[k]));
      ASSERT_EQ(a.domain[i].address, b.domain[k].address);
      ASSERT_EQ(a.radiometry[i].rho, b.radiometry[k].rho);
      ASSERT_EQ(a.radiometry[i].direct, b.radiometry[k].direct);
      if (!b.at(y).flat) continue;
      ASSERT_TRUE(std::ranges::equal(a.outline(x), b.outline(y)));
      ASSERT_EQ(a.frames[a.domain[i].frame].at(Vec2(0.3, 0.4)), b.frames[b.domain[k].frame].at(Vec2(0.3, 0.4)));
    }
  }
  for (const ElementId e : b.inputs) {
    if (!b.isPatch(e) || b.at(e).emitter) continue;
    ASSERT_EQ(a.sides.at(b.sideOf(e)).valid(), b.sides.at(b.sideOf(e)).valid());
  }
  EXPECT_NO_THROW(validate(a));
}

/// Elements that light has been on: what of them is no shape must not be taken.
void light(Elements& elements) {
  for (ElementGeometry& g : elements.geometry) g.exposed = 0.3f, g.meanFreePath = 7;
  for (ElementLight& l : elements.radiometry) l.direct = l.B = Rgb(3.0f);
}

TEST(Fold, UnfoldsToThePartsThereWouldBe) {
  const Scene scene = shapes();
  Elements again = inputLevel(scene), anew = inputLevel(scene);
  refine(again, scene, 6, threeOfFour(1));
  light(again);
  const std::size_t before = again.size();
  fold(again);
  EXPECT_EQ(leavesOf(again).size(), leavesOf(inputLevel(scene)).size());
  expectSame(again, inputLevel(scene));
  refine(again, scene, 6, threeOfFour(2));
  forgetFolded(again);
  refine(anew, scene, 6, threeOfFour(2));
  expectSame(again, anew);
  // What is split alike is where it was; the rest is away.
  std::size_t stayed = 0, faces = 0, curved = 0, deepest = 0;
  for (std::size_t i = 0; i < before; ++i) {
    if (!again.receives(ElementId(i)) || again.topology[i].depth == 0) continue;
    ++stayed;
    faces += again.hasFaces(ElementId(i)), curved += !again.topology[i].flat && !again.hasFaces(ElementId(i));
    deepest = std::max<std::size_t>(deepest, again.topology[i].depth);
  }
  EXPECT_GT(stayed, before / 8);
  EXPECT_GT(faces, 20u);
  EXPECT_GT(curved, 20u);
  EXPECT_GE(deepest, 5u);
  EXPECT_EQ(again.size(), anew.size() + awayIn(again));
  EXPECT_GT(awayIn(again), 20u);
}

TEST(Fold, BringsWhatHasMovedToWhereItIs) {
  const Scene scene = shapes();
  Elements again = inputLevel(scene);
  refine(again, scene, 5, threeOfFour(1));
  light(again);
  for (const int which : {1, 2, 3, 4, 0}) {  // the polygon, the ball, the cylinder, the cone, the polygon again
    const PrimitiveId moved(6 + std::size_t(std::max(which - 1, 0)));
    Scene now = scene;
    const Mat4 by = glm::translate(Mat4(1.0), Vec3(0.1, 0.05 * which, 0.02));
    now.primitives[moved.index()].shape = transformed(scene[moved].shape, by).value();
    fold(again);
    ASSERT_TRUE(bringTo(again, now, std::array{moved}));
    refine(again, now, 5, threeOfFour(3));
    forgetFolded(again);
    Elements anew = inputLevel(now);
    refine(anew, now, 5, threeOfFour(3));
    expectSame(again, anew);
    // And back, so that nothing but one thing has moved next time.
    fold(again);
    ASSERT_TRUE(bringTo(again, scene, std::array{moved}));
    refine(again, scene, 5, threeOfFour(1));
    forgetFolded(again);
  }
}

TEST(Fold, DoesNotBringFineMeshesAnywhere) {
  const Scene scene = shapes();
  Elements elements = inputLevel(scene);
  fold(elements);
  EXPECT_FALSE(bringTo(elements, scene, std::array{PrimitiveId(scene.primitives.size() - 1)}));
}

TEST(CarryOver, TakesThePartsThereWouldBe) {
  // A wall that stands on the floor now and did not: the floor is split along it.
  const Scene scene = shapes();
  Scene walled = scene;
  test::addPolygon(walled, MaterialId(0u), {{1.3, 0, 0}, {1.3, 2, 0}, {1.3, 2, 1.5}, {1.3, 0, 1.5}});
  Elements before = inputLevel(scene), anew = inputLevel(walled), carried = inputLevel(walled);
  refine(before, scene, 5, threeOfFour(1));
  light(before);
  fold(before);
  std::vector<char> stays(walled.primitives.size(), true);
  stays[7] = false;  // the ball
  const std::vector<std::uint32_t> was = carryOver(carried, walled, before, stays);
  ASSERT_EQ(was.size(), carried.size());
  std::size_t taken = 0, elsewhere = 0;
  for (std::size_t i = 0; i < was.size(); ++i) {
    if (was[i] == kNone) {
      elsewhere += carried.receives(ElementId(i)) && i < anew.size();
      continue;
    }
    EXPECT_EQ(carried.key[i], before.key[was[i]]);
    EXPECT_NE(carried.domain[i].primitive.index(), 7u);
    taken += i >= anew.size();
  }
  EXPECT_GT(taken, (before.size() - inputLevel(scene).size()) / 2);  // all but of the floor, the ball, and below them
  EXPECT_GE(elsewhere, 4u);
  refine(carried, walled, 5, threeOfFour(2));
  forgetFolded(carried);
  refine(anew, walled, 5, threeOfFour(2));
  expectSame(carried, anew);
}

TEST(Compacted, LeavesOutWhatIsAway) {
  const Scene scene = shapes();
  Elements again = inputLevel(scene);
  refine(again, scene, 6, threeOfFour(1));
  fold(again);
  refine(again, scene, 6, threeOfFour(2));
  forgetFolded(again);
  const Elements few = compacted(again);
  EXPECT_EQ(few.size(), again.size() - awayIn(again));
  EXPECT_EQ(awayIn(few), 0u);
  expectSame(few, again);
  // In the order they were in.
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < again.size(); ++i)
    if (again.topology[i].kind != ElementKind::Away) keys.push_back(again.key[i]);
  EXPECT_EQ(few.key, keys);
}

}  // namespace
}  // namespace deltalux
