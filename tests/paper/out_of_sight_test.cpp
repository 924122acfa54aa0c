#include "paper/out_of_sight.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "paper/separation.hpp"
#include "paper/visibility.hpp"
#include "support/furnished_room.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace paper;

namespace {

Vec3 pointIn(Rng& rng, const Vec3& lower, const Vec3& upper) {
  return lower + Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * (upper - lower);
}

/// A polygon with a hole, by a seam: of every other pair of boxes that it is said to separate, all segments cross it.
TEST(Separation, HoldsOfAllSegments) {
  const Polygon wall = *makePolygon({{-2, 0, -2},
                                     {2, 0, -2},
                                     {2, 0, 2},
                                     {-2, 0, 2},
                                     {-2, 0, 0.4},
                                     {-0.6, 0, 0.4},
                                     {-0.6, 0, 0.9},
                                     {0.3, 0, 0.9},
                                     {0.3, 0, 0.4},
                                     {-2, 0, 0.4}});
  const hierarchy::PlaneFrame frame{wall.origin, wall.edgeU, wall.edgeV, wall.normal};
  Rng rng(11);
  int separate = 0, open = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 a = pointIn(rng, {-3, -3, -3}, {3, 0.2, 3}), b = pointIn(rng, {-3, -0.2, -3}, {3, 3, 3});
    const Vec3 sizeA = pointIn(rng, {0, 0, 0}, {0.5, 0.5, 0.5}), sizeB = pointIn(rng, {0, 0, 0}, {0.5, 0.5, 0.5});
    const bool apart = separates(frame, wall.outline, cornersOf(a, a + sizeA), cornersOf(b, b + sizeB));
    bool allCross = true;
    for (int i = 0; i < 40; ++i) {
      const Vec3 p = pointIn(rng, a, a + sizeA), q = pointIn(rng, b, b + sizeB);
      const double t = p.y / (p.y - q.y);
      const Vec3 x = glm::mix(p, q, t);
      const bool inside =
          std::abs(x.x) < 2 && std::abs(x.z) < 2 && !(x.x > -0.6 && x.x < 0.3 && x.z > 0.4 && x.z < 0.9);
      allCross = allCross && t > 0 && t < 1 && inside;
    }
    EXPECT_TRUE(!apart || allCross);
    separate += apart, open += !allCross;
  }
  EXPECT_GT(separate, 300);
  EXPECT_GT(open, 300);
}

/// Two rooms side by side, without a door.
TEST(OutOfSight, HoldsOfTheOtherRoomAndOfNothingThatSees) {
  Scene scene = test::furnishedRoom();
  const Box room = bounds(scene);
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.6f));
  const Vec3 lower{room.upper.x + 0.1, room.lower.y, room.lower.z};
  test::addBox(scene, white, lower, lower + Vec3(2, 3, 2.5), true);
  test::addBox(scene, white, lower + Vec3(0.5, 0.5, 0), lower + Vec3(0.9, 1.1, 0.8), false);
  const auto tracer = tracing::makeEmbreeTracer(scene);
  const hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
  const Box region{room.center(), room.center() + Vec3(0.4, 0.3, 0.3)};
  const OutOfSight hidden(elements, scene, region);
  Rng rng(5);
  int inOther = 0, hiddenThere = 0, seeing = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementId e(i);
    if (!elements.isPatch(e)) continue;
    const bool isHidden = hidden.holds(e);
    const bool other = elements.at(e).front && elements.shape(e).lower.x > room.upper.x + 0.05;
    inOther += other, hiddenThere += other && isHidden;
    for (int k = 0; k < 16; ++k) {
      const hierarchy::PatchPoint p = hierarchy::samplePatch(elements, scene, e, rng.uniform(), rng.uniform());
      const Vec3f q(pointIn(rng, region.lower, region.upper));
      if (glm::dot(q - p.position, p.normal) <= 0) continue;
      const bool sees = !tracer->occluded(tracing::segment(p.position, p.normal, q, Vec3f(0.0f)));
      EXPECT_FALSE(isHidden && sees);
      seeing += sees;
    }
  }
  EXPECT_GT(seeing, 100);
  EXPECT_GT(inOther, 5);
  EXPECT_EQ(hiddenThere, inOther);
}

}  // namespace
}  // namespace deltalux
