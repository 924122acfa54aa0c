// Direct light of leaves by keyed shadow rays, against closed forms.
#include "direct/leaf_direct.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hierarchy/build.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

struct Lit {
  explicit Lit(Scene s) : scene(std::move(s)) {
    addAreaLights(scene);
    tracer = tracing::makeEmbreeTracer(scene);
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    lamps.emplace(scene);
  }
  direct::LeafDirect front(PrimitiveId p) const {
    const direct::DirectSampler sampler(elements, scene, *tracer, *lamps, 0.05);
    return sampler.at(elements.side(p, 0, true), {});
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
