// Direct light that a change is said not to touch is the light that is asked for after it, lamps that are drawn too.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "change/known_samples.hpp"
#include "hierarchy/build.hpp"
#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A corner of it.
Vec3 weakLamp(int i) { return {1 + 0.4 * i, 1 + i % 5, 2 + 0.3 * (i % 7)}; }

/// A row of tiles, strong lamps behind a wall and weak ones before it, so that most that bring light are found by rays
/// that were drawn; a small thing between, which is somewhere.
struct TilesAndThing {
  explicit TilesAndThing(const Vec3& at) {
    const MaterialId gray = addMaterial(scene, "gray", lambert(0.5f));
    for (int i = 0; i < 16; ++i) {
      const double x = 1 + 0.5 * i;
      tiles.push_back(addPolygon(scene, gray, {{x, -0.1, 0}, {x + 0.2, -0.1, 0}, {x + 0.2, 0.1, 0}, {x, 0.1, 0}}));
    }
    const auto a = at - Vec3(0.1, 0, 0), b = at + Vec3(0.1, 0, 0), up = Vec3(0, 0, 0.1);
    moving = addPolygon(scene, gray, {a, b, b + up, a + up});
    addPolygon(scene, gray, {{0, -20, 0}, {0, 20, 0}, {0, 20, 9}, {0, -20, 9}});
    const auto addLamp = [this](const Vec3& p, float radiance) {
      const MaterialId glowing = addMaterial(scene, "glowing", lambert(0), Emission{Rgb(radiance), false, {}, {}});
      addPolygon(scene, glowing, {p, p + Vec3(0, 0.4, 0), p + Vec3(0.4, 0.4, 0), p + Vec3(0.4, 0, 0)});
    };
    for (int i = 0; i < 20; ++i) addLamp({-1 - 0.3 * i, i % 5 - 2, 3}, 200);
    for (int i = 0; i < 20; ++i) addLamp(weakLamp(i), 10);
    addAreaLights(scene);
    tracer = tracing::makeEmbreeTracer(scene);
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    lamps.emplace(scene, scene::scalesOf(scene));
    sampler.emplace(elements, scene, *tracer, *lamps, 0.05);
  }
  TilesAndThing(const TilesAndThing&) = delete;

  Scene scene;
  std::vector<PrimitiveId> tiles;
  PrimitiveId moving;
  std::unique_ptr<tracing::RayTracer> tracer;
  hierarchy::Elements elements;
  std::optional<direct::Lamps> lamps;
  std::optional<direct::DirectSampler> sampler;
};

TEST(KnownShadows, HoldWhereLightIsThatWhichIsAskedAgain) {
  constexpr std::uint64_t kAllLamps = ~std::uint64_t(0);
  std::size_t hold = 0, differ = 0, found = 0;
  const TilesAndThing then({0, 0.5, 0.6});
  direct::LampSight above;  // as if all had been asked, and none been seen
  above.asked = kAllLamps, above.drawnAsked = true;
  for (const direct::LampSight& sight : {direct::LampSight{}, above}) {
    for (int place = 0; place < 160; ++place) {
      const TilesAndThing now(weakLamp(place / 8) + Vec3(0.05 * (place % 8), -0.1, -0.3));  // below a lamp
      const change::MovedSpace space(
          now.scene, std::vector<SceneChange::Moved>{
                         {now.moving, bounds(then.scene[then.moving].shape), bounds(now.scene[now.moving].shape)}});
      for (const PrimitiveId tile : then.tiles) {
        const hierarchy::ElementId before = then.elements.side(tile, 0, true), patch = now.elements.side(tile, 0, true);
        const direct::LeafDirect was = then.sampler->at(before, {}, sight), is = now.sampler->at(patch, {}, sight);
        const bool same = was.E == is.E && was.drawn == is.drawn && was.sight.seen == is.sight.seen;
        differ += !same;
        if (!change::holdShadowRays(space, *now.sampler, now.elements, patch, {}, sight, was, kAllLamps)) continue;
        ++hold, found += was.sight.drawnSeen;
        EXPECT_TRUE(same) << "tile " << tile.index() << ", place " << place;
      }
    }
  }
  EXPECT_GT(hold, 1000u);
  EXPECT_GT(found, 100u);  // by rays that were drawn
  EXPECT_GT(differ, 100u);
}

}  // namespace
}  // namespace deltalux
