// What only is seen lights nothing: Radiance's glow of negative radius.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

#include "io/radiance/memory_files.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A glowing square above a grey floor, and a mirror beside it that shows it.
Scene glowing(const std::string& radius) {
  return io::radiance::test::read(
             "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid mirror silver 0 0 3 1 1 1\n"
             "void glow g 0 0 4 10 10 10 " +
             radius + "\nvoid glow b 0 0 4 2 2 2 " + radius +
             "\n"
             "g polygon lamp 0 0 12 -.5 -.5 2  -.5 .5 2  .5 .5 2  .5 -.5 2\n"
             "silver polygon glass 0 0 12 3 -2 0  3 -2 4  3 2 4  3 2 0\n"
             "b source above 0 0 4 0 0 1 60\n"
             "grey polygon floor 0 0 12 -5 -5 0  5 -5 0  5 5 0  -5 5 0\n")
      .scene;
}

View looking(const Vec3& from, const Vec3& to) {
  View view;
  view.position = from, view.direction = to - from, view.up = {0, 1, 0.1};
  view.horizontal = view.vertical = 1;
  return view;
}

double mean(const Image& image) {
  double sum = 0;
  for (const Rgb& L : image.pixels) sum += gray(L) / static_cast<double>(image.pixels.size());
  return sum;
}

const View kStraight = looking({0, 0, 0.5}, {0, 0, 2}), kByMirror = looking({0.1, 0, 0.5}, {3, 0, 1.25}),
           kSky = looking({-4, 0, 0.5}, {-4, 0, 9});
const std::vector<ProbePoint> kPoints{{{0.1, 0.1, 0}, {0, 0, 1}}, {{-1, 0, 1}, {0, 0, 1}}, {{1, 1, 1}, {1, 0, 0}}};

TEST(SeenOnly, GlowOfNegativeRadiusIsSeenAndSendsNothing) {
  const Scene scene = glowing("-1");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.backdrops.size(), 1u);
  EXPECT_NO_THROW(validate(scene));
  ReferenceIntegrator reference(scene, {64});
  for (const ProbeResult& r : reference.probe(kPoints)) EXPECT_EQ(r.irradiance.g, 0);
  EXPECT_NEAR(mean(reference.render(kStraight, 4, 4)), 10, 1e-4);
  EXPECT_NEAR(mean(reference.render(kByMirror, 4, 4)), 10, 1e-4);
  EXPECT_NEAR(mean(reference.render(kSky, 4, 4)), 2, 1e-4);

  const Engine engine = solved(scene, 0.2);
  for (const ProbeResult& r : measure(engine, kPoints)) EXPECT_EQ(r.irradiance.g, 0);
  RenderSettings settings;
  settings.width = settings.height = 4;
  EXPECT_NEAR(mean(render(engine.solution(), kStraight, settings)), 10, 1e-4);
  EXPECT_NEAR(mean(render(engine.solution(), kByMirror, settings)), 10, 1e-4);
  EXPECT_NEAR(mean(render(engine.solution(), kSky, settings)), 2, 1e-4);
}

TEST(SeenOnly, OtherGlowsSendLight) {
  for (const char* radius : {"0", "3"}) {
    const Scene scene = glowing(radius);
    EXPECT_EQ(scene.lights.size(), 2u) << radius;
    EXPECT_TRUE(scene.backdrops.empty());
    ReferenceIntegrator reference(scene, {256});
    EXPECT_GT(reference.probe(kPoints)[0].irradiance.g, 1) << radius;
  }
}

}  // namespace
}  // namespace deltalux
