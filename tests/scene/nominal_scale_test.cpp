#include "scene/nominal_scale.hpp"

#include <gtest/gtest.h>

#include <deltalux/edit.hpp>

#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

Scene lampAndSky() {
  Scene scene;
  addLight(scene, PointLight{{0, 0, 1}, Rgb(1.0f)});
  scene.lights.back().name = "lamp";
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  scene.lights.back().name = "sky";
  return scene;
}

std::vector<Rgb> nominalAt(const Rgb& lamp, const Rgb& sky) {
  Scene scene = lampAndSky();
  scene.lights[0].scale = lamp, scene.lights[1].scale = sky;
  return scene::nominalScales(scene);
}

TEST(NominalScale, IsOneHoweverLampsAreDimmed) {
  for (const Rgb& scale : {Rgb(1.0f), Rgb(0.5f), Rgb(1e-3f), Rgb(0.0f), Rgb(1, 0.2, 0)})
    EXPECT_EQ(nominalAt(scale, Rgb(1.0f))[0], Rgb(1.0f));
}

TEST(NominalScale, RisesByPowersOf16) {
  EXPECT_EQ(nominalAt(Rgb(1.001f), Rgb(1.0f))[0], Rgb(16.0f));
  EXPECT_EQ(nominalAt(Rgb(16.0f), Rgb(1.0f))[0], Rgb(16.0f));
  EXPECT_EQ(nominalAt(Rgb(0, 0, 17), Rgb(1.0f))[0], Rgb(256.0f));
}

TEST(NominalScale, OfTheSkyFallsWithIt) {
  EXPECT_EQ(nominalAt(Rgb(1.0f), Rgb(0.07f))[1], Rgb(1.0f));
  EXPECT_EQ(nominalAt(Rgb(1.0f), Rgb(0.06f))[1], Rgb(1.0f / 16));
  EXPECT_EQ(nominalAt(Rgb(1.0f), Rgb(0.0f))[1], Rgb(0.0f));
}

TEST(NominalScale, TimesTheDimmingIsTheScale) {
  Scene scene = lampAndSky();
  for (const Rgb& scale : {Rgb(1.0f), Rgb(0.3f, 2, 5), Rgb(0.01f), Rgb(0.0f)}) {
    scene.lights[0].scale = scene.lights[1].scale = scale;
    const std::vector<Rgb> nominal = scene::nominalScales(scene), dimming = scene::dimming(scene);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(nominal[i] * dimming[i], scale);
  }
}

}  // namespace
}  // namespace deltalux
