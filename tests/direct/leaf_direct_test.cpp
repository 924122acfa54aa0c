// Direct light of leaves by keyed shadow rays, against closed forms.
#include "direct/leaf_direct.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "hierarchy/build.hpp"
#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

struct Lit {
  explicit Lit(Scene s) : scene(std::move(s)) {
    addAreaLights(scene);
    tracer = tracing::makeEmbreeTracer(scene);
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    lamps.emplace(scene, scene::scalesOf(scene));
  }
  direct::LeafDirect front(PrimitiveId p, const direct::LampSight& above = {}) const {
    const direct::DirectSampler sampler(elements, scene, *tracer, *lamps, 0.05);
    return sampler.at(elements.side(p, 0, true), {}, above);
  }

  Scene scene;
  std::unique_ptr<tracing::RayTracer> tracer;
  hierarchy::Elements elements;
  std::optional<direct::Lamps> lamps;
};

PrimitiveId addTile(Scene& scene, double x, double size) {
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  return addPolygon(scene, white, {{x, -size, 0}, {x + 2 * size, -size, 0}, {x + 2 * size, size, 0}, {x, size, 0}});
}

TEST(LeafDirect, APointLightByTheInverseSquare) {
  Scene scene;
  const PrimitiveId tile = addTile(scene, 3, 0.005);
  addLight(scene, PointLight{{0, 0, 4}, Rgb(10.0f)});
  const Lit lit(std::move(scene));
  EXPECT_NEAR(lit.front(tile).E.g, 10 * (4.0 / 5) / 25, 2e-3 * 10 / 25);
}

TEST(LeafDirect, TheSunByItsCosineAndNothingFromBehind) {
  Scene scene;
  const PrimitiveId tile = addTile(scene, 0, 0.5);
  SunLight sun;
  sun.direction = glm::normalize(Vec3(1, 0, 1)), sun.radiance = Rgb(1e5f);
  addLight(scene, sun);
  sun.direction = glm::normalize(Vec3(1, 0, -1));
  addLight(scene, sun);
  const double whole = 1e5 * solidAngle(sun);
  const Lit lit(std::move(scene));
  EXPECT_NEAR(lit.front(tile).E.g, whole * std::sqrt(0.5), 2e-3 * whole);
  EXPECT_NEAR(lit.front(tile).variation, 0, 1e-3 * whole);
}

TEST(LeafDirect, AHalfShadowVariesAndHasHalfTheLight) {
  Scene scene;
  const PrimitiveId tile = addTile(scene, -0.5, 0.5);
  addPolygon(scene, addMaterial(scene, "lid", lambert(0)), {{-2, -2, 0.1}, {0, -2, 0.1}, {0, 2, 0.1}, {-2, 2, 0.1}});
  SunLight sun;
  sun.direction = {0, 0, 1}, sun.radiance = Rgb(1e5f);
  addLight(scene, sun);
  const double whole = 1e5 * solidAngle(sun);
  const Lit lit(std::move(scene));
  const direct::LeafDirect light = lit.front(tile);
  EXPECT_NEAR(light.E.g, 0.5 * whole, 0.03 * whole);
  EXPECT_GT(light.variation, 0.4 * whole);
}

TEST(LeafDirect, ShadowsThatAreKnownAreNotTracedAgain) {
  // A tile half under a lid, and half of the rest behind a pane, below the sun and two lamps.
  Scene scene;
  const PrimitiveId tile = addTile(scene, -0.5, 0.5);
  addPolygon(scene, addMaterial(scene, "lid", lambert(0)), {{-2, -2, 0.1}, {0, -2, 0.1}, {0, 2, 0.1}, {-2, 2, 0.1}});
  addPolygon(scene, addMaterial(scene, "pane", ThinGlass{Rgb(0.7f), 1.5f}),
             {{0, -2, 0.1}, {2, -2, 0.1}, {2, 0, 0.1}, {0, 0, 0.1}});
  SunLight sun;
  sun.direction = {0, 0, 1}, sun.radiance = Rgb(1e5f);
  addLight(scene, sun);
  addLight(scene, PointLight{{0.2, 0, 2}, Rgb(10.0f)});
  addLight(scene, PointLight{{-1, 1, 3}, Rgb(20.0f)});
  const Lit lit(std::move(scene));
  const direct::DirectSampler sampler(lit.elements, lit.scene, *lit.tracer, *lit.lamps, 0.05);
  const hierarchy::ElementId patch = lit.elements.side(tile, 0, true);
  const direct::LeafDirect first = sampler.at(patch, {});
  std::uint64_t clear = 0, shut = 0;
  for (const direct::LampLight& l : first.lamps) {
    EXPECT_EQ(l.shadows.clear & l.shadows.shut, 0u);
    EXPECT_EQ((l.shadows.clear | l.shadows.shut) >> (l.points - 1) >> 1, 0u);
    clear += static_cast<std::uint64_t>(std::popcount(l.shadows.clear));
    shut += static_cast<std::uint64_t>(std::popcount(l.shadows.shut));
  }
  EXPECT_GT(clear, 10u);
  EXPECT_GT(shut, 10u);
  EXPECT_GT(first.rays, clear + shut);  // those through the pane
  const auto sameLight = [&](const direct::LeafDirect& light) {
    EXPECT_EQ(light.E, first.E);
    EXPECT_EQ(light.deviation, first.deviation);
    EXPECT_EQ(light.variation, first.variation);
    ASSERT_EQ(light.lamps.size(), first.lamps.size());
    for (std::size_t i = 0; i < light.lamps.size(); ++i) {
      EXPECT_EQ(light.lamps[i].E, first.lamps[i].E);
      EXPECT_EQ(light.lamps[i].shadows.clear, first.lamps[i].shadows.clear);
      EXPECT_EQ(light.lamps[i].shadows.shut, first.lamps[i].shadows.shut);
    }
  };
  const auto again = [&](bool holds) {
    const direct::DirectSampler::KnownShadows before{first.lamps,
                                                     [=](const direct::Lamp&, const tracing::Ray&) { return holds; }};
    return sampler.at(patch, {}, {}, {}, &before);
  };
  sameLight(again(true)), sameLight(again(false));
  EXPECT_EQ(again(false).rays, first.rays);
  EXPECT_EQ(again(true).rays, first.rays - clear - shut);
}

/// Tiles of two rooms with a wall between, which has a gap, and six lamps in each; the last one is somewhere.
Scene twoRooms(const Vec3& last, std::vector<PrimitiveId>& tiles) {
  Scene scene;
  for (int i = 0; i < 64; ++i) tiles.push_back(addTile(scene, -8 + 0.25 * i, 0.1));
  addPolygon(scene, addMaterial(scene, "wall", lambert(0.5f)), {{0, -9, 0.2}, {0, 9, 0.2}, {0, 9, 9}, {0, -9, 9}});
  for (int i = 0; i < 11; ++i) addLight(scene, PointLight{{-7.5 + 1.3 * i, 0.5, 2 + 0.1 * i}, Rgb(5.0f)});
  addLight(scene, PointLight{last, Rgb(1.0f)});
  return scene;
}

TEST(LeafDirect, StandsWhereNoLampThatMovedIsAskedOrFound) {
  std::vector<PrimitiveId> tiles;
  const Lit before(twoRooms({7, 0.5, 3}, tiles));
  const direct::DirectSampler sampler(before.elements, before.scene, *before.tracer, *before.lamps, 0.05);
  std::vector<char> moved(before.scene.lights.size(), 0);
  moved.back() = 1;
  std::size_t stand = 0, differ = 0;
  for (const Vec3& to : {Vec3(6.8, 0.4, 3), Vec3(5, -1, 1), Vec3(-3, 0, 2)}) {
    std::vector<PrimitiveId> same;
    const Lit after(twoRooms(to, same));
    const direct::DirectSampler now(after.elements, after.scene, *after.tracer, *after.lamps, 0.05);
    for (const PrimitiveId tile : tiles) {
      const hierarchy::ElementId patch = before.elements.side(tile, 0, true);
      direct::LampSight above;  // as if all had been asked, and none been seen
      above.asked = ~std::uint64_t(0), above.drawnAsked = true;
      const direct::LeafDirect was = sampler.at(patch, {}, above), is = now.at(patch, {}, above);
      std::uint64_t rays = 0;
      const bool holds = now.stands(patch, {}, above, was, before.lamps->tree(), moved, rays);
      differ += was.E != is.E;
      if (!holds) continue;
      ++stand;
      EXPECT_EQ(was.E, is.E);
      EXPECT_EQ(was.variation, is.variation);
      EXPECT_EQ(was.sight.asked, is.sight.asked);
      EXPECT_EQ(was.sight.seen, is.sight.seen);
      EXPECT_EQ(was.sight.drawnAsked, is.sight.drawnAsked);
      EXPECT_EQ(was.drawn, is.drawn);
      ASSERT_EQ(was.lamps.size(), is.lamps.size());
      for (std::size_t i = 0; i < is.lamps.size(); ++i) {
        EXPECT_EQ(was.lamps[i].lamp, is.lamps[i].lamp);
        EXPECT_EQ(was.lamps[i].E, is.lamps[i].E);
        EXPECT_EQ(was.lamps[i].points, is.lamps[i].points);
      }
    }
  }
  EXPECT_GT(stand, 10u);
  EXPECT_GT(differ, 5u);
}

TEST(LeafDirect, ManyLampsAreRightInTheMean) {
  Scene scene;
  const PrimitiveId tile = addTile(scene, -0.01, 0.01);
  double expected = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3 at(i - 9.5, j - 9.5, 3);
      addLight(scene, PointLight{at, Rgb(1.0f)});
      const double d2 = glm::dot(at, at);
      expected += at.z / std::sqrt(d2) / d2;
    }
  const Lit lit(std::move(scene));
  EXPECT_NEAR(lit.front(tile).E.g, expected, 0.15 * expected);
}

/// Unshadowed light of a lamp of intensity 1 on the ground [W/m2].
double fromLampAt(const Vec3& d) { return d.z / std::pow(glm::dot(d, d), 1.5); }

/// A row of small tiles, and many lamps of different power over them; a wall at x = 0 hides those beyond.
struct ManyLamps {
  ManyLamps(int visible, int hidden, double bright = 1) {
    for (int i = 0; i < 64; ++i) tiles.push_back(addTile(scene, 1 + 0.1 * i, 0.001));
    addPolygon(scene, addMaterial(scene, "wall", lambert(0)), {{0, -99, -1}, {0, 99, -1}, {0, 99, 99}, {0, -99, 99}});
    expected.assign(tiles.size(), 0);
    const auto add = [&](int i, double side) {
      const double power = (1 + i % 7) * (side > 0 ? bright : 1.0);
      const Vec3 at(side * (1 + i % 10), -8 + 1.7 * (i / 10 % 10), 3 + 0.1 * (i / 100));
      addLight(scene, PointLight{at, Rgb(static_cast<float>(power))});
      for (std::size_t t = 0; side > 0 && t < tiles.size(); ++t)
        expected[t] += power * fromLampAt(at - Vec3(1.001 + 0.1 * static_cast<double>(t), 0, 0));
    };
    for (int i = 0; i < visible; ++i) add(i, 1);
    for (int i = 0; i < hidden; ++i) add(i, -1);
  }

  Scene scene;
  std::vector<PrimitiveId> tiles;
  std::vector<double> expected;
};

TEST(LeafDirect, DrawnLampsAreRightInTheMean) {
  ManyLamps many(200, 200);
  const Lit lit(std::move(many.scene));
  double sum = 0, expected = 0;
  for (std::size_t t = 0; t < many.tiles.size(); ++t) {
    const direct::LeafDirect light = lit.front(many.tiles[t]);
    sum += light.E.g, expected += many.expected[t];
    EXPECT_NEAR(light.E.g, many.expected[t], 0.5 * many.expected[t]);
    EXPECT_GT(light.deviation, 0);
  }
  EXPECT_NEAR(sum, expected, 0.03 * expected);
}

TEST(LeafDirect, HiddenLampsCostFewRays) {
  ManyLamps alone(4, 0, 40), many(4, 400, 40);
  const Lit few(std::move(alone.scene)), all(std::move(many.scene));
  std::uint32_t raysOfFew = 0, raysOfAll = 0;
  for (std::size_t t = 0; t < many.tiles.size(); ++t) {
    const direct::LeafDirect first = all.front(many.tiles[t]);
    EXPECT_NEAR(first.E.g, many.expected[t], 1e-3 * many.expected[t]);
    raysOfFew += few.front(alone.tiles[t]).rays;
    raysOfAll += all.front(many.tiles[t], first.sight).rays;
  }
  const auto tiles = static_cast<std::uint32_t>(many.tiles.size());
  EXPECT_LT(raysOfAll, raysOfFew + 60 * tiles);  // 24 asked one by one, and some of the others
}

TEST(LeafDirect, WhatThePatchAboveHasMissedIsFound) {
  ManyLamps many(200, 0);
  const Lit lit(std::move(many.scene));
  direct::LampSight missed;
  missed.asked = ~std::uint64_t(0), missed.drawnAsked = true;
  double sum = 0, expected = 0;
  for (std::size_t t = 0; t < many.tiles.size(); ++t) {
    const direct::LeafDirect light = lit.front(many.tiles[t], missed);
    sum += light.E.g, expected += many.expected[t];
    EXPECT_TRUE(light.sight.drawnSeen);
  }
  EXPECT_NEAR(sum, expected, 0.03 * expected);
}

TEST(LeafDirect, DoublesWithThePowerOfAllLamps) {
  ManyLamps once(60, 60), twice(60, 60);
  for (Light& light : twice.scene.lights) light.scale *= 2.0f;
  const Lit first(std::move(once.scene)), second(std::move(twice.scene));
  for (std::size_t t = 0; t < once.tiles.size(); t += 7)
    EXPECT_FLOAT_EQ(2 * first.front(once.tiles[t]).E.g, second.front(twice.tiles[t]).E.g);
}

TEST(Lamps, ANarrowBeamIsFoundByItsWidth) {
  Scene scene;
  const PrimitiveId tile = addTile(scene, -5, 5);
  SpotLight spot;
  spot.position = {1.3, 0.7, 4}, spot.direction = {0, 0, -1}, spot.intensity = Rgb(100.0f);
  spot.cosInner = std::cos(0.02), spot.cosOuter = std::cos(0.03);
  addLight(scene, spot);
  const Lit lit(std::move(scene));
  EXPECT_TRUE(lit.front(tile).tooWideForBeam);
}

}  // namespace
}  // namespace deltalux
