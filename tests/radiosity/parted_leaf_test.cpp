// Leaves on both sides of a wall: their light stays on its side.
#include "radiosity/parted_leaf.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "hierarchy/build.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace radiosity;

namespace {

/// A square of ground, 8 by 8, as one leaf, with a block on it.
struct Ground {
  Scene scene;
  hierarchy::Elements elements;
  std::unique_ptr<tracing::RayTracer> tracer;

  Ground(const Vec3& lower, const Vec3& upper) {
    const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
    test::addPolygon(scene, grey, {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}});
    test::addBox(scene, grey, lower, upper, false);
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    tracer = tracing::makeEmbreeTracer(scene);
  }
  bool parted(std::size_t a, std::size_t b) const {
    return standsBetween(elements, scene, *tracer, elements.side(PrimitiveId(0u), 0, true), a, b);
  }
};

TEST(PartedLeaf, AWallPartsWhatItStandsBetween) {
  const Ground ground({3.9, 0, 0}, {4.1, 8, 3});  // along y, through the middle of x
  EXPECT_TRUE(ground.parted(0, 1));
  EXPECT_TRUE(ground.parted(0, 3));
  EXPECT_TRUE(ground.parted(2, 1));
  EXPECT_FALSE(ground.parted(0, 2));
  EXPECT_FALSE(ground.parted(1, 3));
}

TEST(PartedLeaf, APostOrAStepPartsNothing) {
  EXPECT_FALSE(Ground({4, 4, 0}, {4.2, 4.2, 3}).parted(0, 1));
  EXPECT_FALSE(Ground({3.9, 0, 0}, {4.1, 8, 0.1}).parted(0, 1));
}

/// A shed on open ground under a bright sky, and a lamp in it: four walls and a lid, without a floor of its own. Turned
/// by an angle about its middle [rad]; its walls stand on no edge of any leaf that is split in its middle.
Scene shed(float sky, double angle) {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.7f));
  test::addPolygon(scene, grey, {{0, 0, 0}, {24, 0, 0}, {24, 24, 0}, {0, 24, 0}});
  const Vec3 a(10.3, 9.7, 0), b(14.6, 13.4, 2.5);
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    test::addPolygon(scene, grey, {{x0, y0, 0}, {x1, y1, 0}, {x1, y1, b.z}, {x0, y0, b.z}});
  };
  wall(a.x, a.y, b.x, a.y), wall(b.x, a.y, b.x, b.y), wall(b.x, b.y, a.x, b.y), wall(a.x, b.y, a.x, a.y);
  test::addPolygon(scene, grey, {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
  const Vec3 middle = 0.5 * (a + b);
  const Mat4 turn = glm::translate(Mat4(1.0), middle) * glm::rotate(Mat4(1.0), angle, Vec3(0, 0, 1)) *
                    glm::translate(Mat4(1.0), -middle);
  if (angle != 0)
    for (std::size_t i = 1; i < scene.primitives.size(); ++i)
      scene.primitives[i].shape = *transformed(scene.primitives[i].shape, turn);
  if (sky > 0) test::addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(sky), UniformSky{1.0}, {0, 0, 1}});
  test::addLight(scene, PointLight{{12, 11, 2}, Rgb(1.0f)});
  return scene;
}

/// What falls on the shed's walls and lid inside [W].
double inShed(float sky, double angle) {
  Engine engine(shed(sky, angle));
  engine.solve();
  const hierarchy::Elements& elements = engine.solution().get().elements;
  double inside = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementId e(i);
    if (!elements.isReceivingLeaf(e) || elements.domain[i].primitive == PrimitiveId(0u) || elements.at(e).front)
      continue;
    const hierarchy::ElementLight& l = elements.radiometry[i];
    inside += double(elements.shape(e).area) * gray(l.direct + l.indirect);
  }
  return inside;
}

/// 144 W of the 1,600 that fall on the shed outside came in when leaves were split neither for the sky nor for walls.
TEST(PartedLeaf, NoSkyShinesUnderTheWallsOfAShed) {
  const double dark = inShed(0, 0), bright = inShed(10, 0);
  EXPECT_GT(dark, 30);
  EXPECT_NEAR(bright, dark, 0.15 * dark);
}

/// Leaves do not end at walls that stand askew, but are split finer there: 46 W come in.
TEST(PartedLeaf, LittleSkyShinesUnderTheWallsOfAShedThatStandsAskew) {
  const double dark = inShed(0, 0.5), bright = inShed(10, 0.5);
  EXPECT_GT(dark, 30);
  EXPECT_LT(bright - dark, 60);
}

}  // namespace
}  // namespace deltalux
