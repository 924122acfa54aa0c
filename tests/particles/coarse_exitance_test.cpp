// What decides how many particles cells send, held against irradiance worked out by hand.
#include "particles/coarse_exitance.hpp"

#include <gtest/gtest.h>

#include "particles/plan_particles.hpp"
#include "particles/tuning.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr double kReflectance = particles::tuning::kNominalReflectance;

struct Estimated {
  Scene scene;
  scene::LightSampler lights;
  Senders senders;
  CoarseExitance exitance;

  explicit Estimated(Scene s, double caustic = 0)
      : scene(std::move(s)), lights(scene), senders(scene, lights), exitance(estimate(caustic)) {}

  Vec3 middle(std::uint32_t cell) const { return senders.point(cell, {0.5, 0.5}).position; }

  /// Sum over the sides of surfaces whose middle `counts` [W].
  template <class Counts>
  double flux(const Counts& counts) const {
    double sum = 0;
    for (std::uint32_t c = senders.surfaceCells(); c < senders.cells().size(); ++c)
      if (senders.cells()[c].front && counts(middle(c))) sum += senders.cells()[c].measure * exitance.perCell[c];
    return sum;
  }

 private:
  CoarseExitance estimate(double caustic) const {
    std::vector<double> caustics(senders.cells().size(), 0.0);
    caustics[senders.surfaceCells()] = caustic;
    return coarseExitance(scene, *tracing::makeEmbreeTracer(scene), lights, senders, caustics);
  }
};

/// A floor of a square metre at z = 0, and nothing else.
Scene floorOnly() {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.8f));
  test::addPolygon(scene, white, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  return scene;
}

TEST(CoarseExitance, OfAFloorUnderALampIsItsIrradianceTimesTheNominalReflectance) {
  Scene scene = floorOnly();
  test::addLight(scene, PointLight{{0.5, 0.5, 1.5}, Rgb(3.0f)});
  const Estimated e(std::move(scene));
  for (std::uint32_t c = e.senders.surfaceCells(); c < e.senders.cells().size(); ++c) {
    if (!e.senders.cells()[c].front) continue;
    const Vec3 d = Vec3(0.5, 0.5, 1.5) - e.middle(c);
    const double expected = kReflectance * 3.0 * d.z / std::pow(glm::dot(d, d), 1.5);
    EXPECT_NEAR(e.exitance.perCell[c] / expected, 1.0, 0.03) << c;
  }
}

TEST(CoarseExitance, CountsEveryLightOfMany) {
  Scene scene = floorOnly();
  double expected = 0;
  // The square's form factor to a small lamp is left out of both: lamps stand in a row, one in fifty is bright.
  for (int i = 0; i < 500; ++i) {
    const float intensity = i % 50 == 7 ? 20.0f : 0.1f;
    test::addLight(scene, PointLight{{0.5, 0.5, 20.0 + 1e-3 * i}, Rgb(intensity)});
    expected += kReflectance * intensity / std::pow(20.0 + 1e-3 * i, 2);
  }
  const Estimated e(std::move(scene));
  EXPECT_NEAR(e.flux([](const Vec3&) { return true; }) / expected, 1.0, 0.05);
}

TEST(CoarseExitance, LightGoesFromCellToCell) {
  // A closed box with a lamp in its middle: a quarter of the flux after two bounces, an eighth after three.
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "white", test::lambert(0.3f)), Vec3(0), Vec3(2), true);
  test::addLight(scene, PointLight{{1, 1, 1}, Rgb(1.0f)});
  const Estimated e(std::move(scene));
  double share = 0;
  for (int bounce = 1; bounce <= 5; ++bounce) share += std::pow(kReflectance, bounce);
  EXPECT_NEAR(e.flux([](const Vec3&) { return true; }) / (4 * kPi * share), 1.0, 0.03);
}

TEST(CoarseExitance, CausticsAreTheirFluxOverTheCell) {
  const Estimated e(floorOnly(), 2.0);
  const std::uint32_t c = e.senders.surfaceCells();
  EXPECT_NEAR(e.exitance.perCell[c] / (kReflectance * 2.0 / e.senders.cells()[c].measure), 1.0, 1e-5);
}

TEST(CoarseExitance, NoCellIsLeftOut) {
  // One room is lit, the other has no light that a ray could find: it may still have some. Backs count in the mean.
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.8f));
  test::addBox(scene, white, Vec3(0), Vec3(2), true);
  test::addBox(scene, white, Vec3(3, 0, 0), Vec3(5, 2, 2), true);
  test::addLight(scene, PointLight{{1, 1, 1}, Rgb(1.0f)});
  const Estimated e(std::move(scene));
  const double lit = e.flux([](const Vec3&p) { return p.x < 2.5; }),
               dark = e.flux([](const Vec3&p) { return p.x > 2.5; });
  EXPECT_GT(dark, 0.002 * lit);
  EXPECT_LT(dark, 0.5 * lit);
}

TEST(CoarseExitance, KnowsNothingOfScalesAndColours) {
  const auto lit = [](float albedo, float scale) {
    Scene scene;
    test::addBox(scene, test::addMaterial(scene, "paint", test::lambert(albedo)), Vec3(0), Vec3(2), true);
    test::addPolygon(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
                     {{0.5, 1.9, 0.5}, {0.5, 1.9, 1.5}, {1.5, 1.9, 1.5}});
    test::addLight(scene, PointLight{{1, 1, 1}, Rgb(1.0f)});
    test::addLight(scene, PointLight{{0.5, 0.5, 1.8}, Rgb(2.0f)});
    scene.lights[1].scale = Rgb(scale);
    ParticleSettings settings;
    settings.count = 1000;
    return counted(planParticles(scene, *tracing::makeEmbreeTracer(scene), settings), settings.count).nominal;
  };
  EXPECT_EQ(lit(0.8f, 1.0f), lit(0.1f, 0.0f));
}

}  // namespace
}  // namespace deltalux
