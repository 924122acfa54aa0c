// Parts that are known from elements before are the parts that there would be, to the last bit.
#include <gtest/gtest.h>

#include <cstring>
#include <unordered_map>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
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

/// Splits patches level by level, those of each that `chooses(key)`; with what is known, if anything is.
template <class Chooses>
void refine(Elements& elements, const Scene& scene, int levels, const Chooses& chooses, KnownParts* known = nullptr) {
  std::vector<ElementId> parts;
  for (const ElementId e : elements.inputs)
    if (elements.receives(e)) parts.push_back(e);
  for (int level = 0; level < levels; ++level) {
    std::erase_if(parts, [&](ElementId e) { return !chooses(elements.key[e.index()]); });
    const std::vector<char> split = subdivide(elements, scene, parts, known);
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

/// What inputs were in elements before, by key.
KnownParts knownOf(const Elements& before, const Elements& elements) {
  std::unordered_map<std::uint64_t, std::uint32_t> byKey;
  for (const ElementId e : before.inputs) byKey[before.key[e.index()]] = e.value;
  KnownParts known{&before, std::vector<std::uint32_t>(elements.size(), kNone)};
  for (const ElementId e : elements.inputs)
    if (const auto at = byKey.find(elements.key[e.index()]); at != byKey.end()) known.of[e.index()] = at->second;
  return known;
}

void expectSame(const Elements& a, const Elements& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.key, b.key);
  EXPECT_EQ(a.outlines, b.outlines);
  EXPECT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.topology[i].parent, b.topology[i].parent) << i;
    ASSERT_EQ(a.topology[i].firstChild, b.topology[i].firstChild) << i;
    ASSERT_EQ(a.topology[i].childCount, b.topology[i].childCount) << i;
    ASSERT_TRUE(a.topology[i].front == b.topology[i].front && a.topology[i].flat == b.topology[i].flat &&
                a.topology[i].depth == b.topology[i].depth)
        << i;
    ASSERT_TRUE(sameBytes(a.geometry[i], b.geometry[i])) << i;
    ASSERT_TRUE(sameBytes(a.nodes[i], b.nodes[i])) << i;
    ASSERT_TRUE(sameBytes(a.moments[i], b.moments[i])) << i;
    ASSERT_TRUE(sameBytes(a.domain[i], b.domain[i])) << i;
    ASSERT_EQ(a.radiometry[i].rho, b.radiometry[i].rho) << i;
  }
  EXPECT_NO_THROW(validate(a));
}

/// Elements that light has been on: what of them is no shape must not be taken.
void light(Elements& elements) {
  for (ElementGeometry& g : elements.geometry) g.exposed = 0.3f, g.meanFreePath = 7;
  for (ElementLight& l : elements.radiometry) l.direct = l.B = Rgb(3.0f);
}

TEST(KnownParts, AreThePartsThereWouldBe) {
  const Scene scene = shapes();
  Elements before = inputLevel(scene), anew = inputLevel(scene), taken = inputLevel(scene);
  refine(before, scene, 6, threeOfFour(1));
  light(before);
  refine(anew, scene, 6, threeOfFour(2));
  KnownParts known = knownOf(before, taken);
  refine(taken, scene, 6, threeOfFour(2), &known);
  expectSame(taken, anew);
  // Most of what there was is followed down to the lowest parts; each is what it is taken for.
  std::size_t followed = 0, faces = 0, curved = 0, deepest = 0;
  known.of.resize(taken.size(), kNone);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (known.of[i] == kNone || taken.topology[i].depth == 0) continue;
    EXPECT_EQ(taken.key[i], before.key[known.of[i]]);
    ++followed;
    faces += taken.hasFaces(ElementId(i)), curved += !taken.topology[i].flat && !taken.hasFaces(ElementId(i));
    deepest = std::max<std::size_t>(deepest, taken.topology[i].depth);
  }
  EXPECT_GT(followed, taken.size() / 8);
  EXPECT_GT(faces, 20u);
  EXPECT_GT(curved, 20u);
  EXPECT_GE(deepest, 5u);
}

TEST(KnownParts, AreNotTakenWhereAPatchIsSplitElsewhere) {
  // A wall that stands on the floor now and did not: the floor is split along it.
  const Scene scene = shapes();
  Scene walled = scene;
  test::addPolygon(walled, MaterialId(0u), {{1.3, 0, 0}, {1.3, 2, 0}, {1.3, 2, 1.5}, {1.3, 0, 1.5}});
  Elements before = inputLevel(scene), anew = inputLevel(walled), taken = inputLevel(walled);
  const auto all = [](std::uint64_t) { return true; };
  refine(before, scene, 4, all);
  light(before);
  refine(anew, walled, 4, all);
  KnownParts known = knownOf(before, taken);
  refine(taken, walled, 4, all, &known);
  expectSame(taken, anew);
  std::size_t elsewhere = 0;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (const PatchDomain& d = taken.domain[i]; taken.isPatch(ElementId(i)) && taken.topology[i].depth == 1 &&
                                                known.of[i] == kNone && d.primitive.index() < scene.primitives.size())
      ++elsewhere;
  EXPECT_GT(elsewhere, 3u);
}

TEST(KnownParts, AreNoneOfWhatIsNotKnown) {
  const Scene scene = shapes();
  const Elements before = inputLevel(scene);  // not split at all
  Elements anew = inputLevel(scene), taken = inputLevel(scene);
  refine(anew, scene, 3, threeOfFour(2));
  KnownParts known = knownOf(before, taken);
  refine(taken, scene, 3, threeOfFour(2), &known);
  expectSame(taken, anew);
  KnownParts none{&before, {}};
  Elements again = inputLevel(scene);
  none.of.assign(again.size(), kNone);
  refine(again, scene, 3, threeOfFour(2), &none);
  expectSame(again, anew);
}

}  // namespace
}  // namespace deltalux
