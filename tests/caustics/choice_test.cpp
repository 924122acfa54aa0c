#include "caustics/choice.hpp"

#include <gtest/gtest.h>

#include "caustics/surface_impacts.hpp"
#include "caustics/synthetic.hpp"

namespace deltalux {
using namespace caustics;

namespace {

struct Histogram {
  Shape shape = test::unitSquare();
  Charts charts = chartsOf(shape);
  CellGrid grid = test::gridOver(shape, charts, 16, 16);
  CellLight light;

  explicit Histogram(const std::vector<particles::Impact>& impacts) {
    light = collect(grid, placeImpacts(shape, charts, impacts)[0]);
  }
};

TEST(Choice, EvenLightIsLeftToTheMeshWhateverItsNoise) {
  int textures = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    for (const std::size_t n : {50u, 1000u, 20000u}) {
      const Histogram h(test::drawImpacts(n, seed, test::evenly));
      textures += deservesTexture(departure(h.grid, h.light), 0.05, 0);
    }
  EXPECT_LE(textures, 1);  // of 300, at four standard deviations
}

TEST(Choice, SmoothGradientsAreLeftToTheMesh) {
  const auto ramp = [](Rng& rng) {
    for (;;) {
      const double u = rng.uniform(), v = rng.uniform();
      if (rng.uniform() < 0.5 + 0.5 * u) return test::inSquare(u, v);
    }
  };
  const Histogram h(test::drawImpacts(20000, 1, ramp));
  EXPECT_FALSE(deservesTexture(departure(h.grid, h.light), 0.05, 0));
}

TEST(Choice, FiguresGetTextures) {
  for (const std::size_t n : {400u, 2000u, 20000u}) {
    const Histogram h(test::drawImpacts(n, 1, test::discInEvenLight));
    EXPECT_TRUE(deservesTexture(departure(h.grid, h.light), 0.05, 0)) << n;
  }
}

/// Every so-many-th of the particles is so many times heavier: light that few paths bring.
std::vector<particles::Impact> withHeavyOnes(std::vector<particles::Impact> impacts, std::size_t every, float times) {
  for (std::size_t i = 0; i < impacts.size(); i += every) impacts[i].flux *= times;
  return impacts;
}

TEST(Choice, FewHeavyParticlesDoNotHideAFigureElsewhere) {
  const auto corner = [](Rng& rng) {
    const double u = rng.uniform();
    return test::inSquare(0.1 * u, 1 - 0.1 * rng.uniform());
  };
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::vector<particles::Impact> impacts = test::drawImpacts(5000, seed, test::discInEvenLight);
    const std::vector<particles::Impact> heavy = withHeavyOnes(test::drawImpacts(5000, seed, corner), 1, 300.0f);
    impacts.insert(impacts.end(), heavy.begin(), heavy.begin() + 3);
    const Histogram h(impacts);
    EXPECT_TRUE(deservesTexture(departure(h.grid, h.light), 0.05, 0)) << seed;
  }
}

TEST(Choice, EvenLightOfUnevenParticlesIsLeftToTheMesh) {
  int textures = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    for (const std::size_t every : {10u, 100u, 1000u}) {
      const Histogram h(withHeavyOnes(test::drawImpacts(5000, seed, test::evenly), every, 100.0f));
      textures += deservesTexture(departure(h.grid, h.light), 0.05, 0);
    }
  EXPECT_LE(textures, 1);  // of 300
}

TEST(Choice, FiguresThatOtherLightDrownsDoNot) {
  const Histogram h(test::drawImpacts(20000, 1, test::discInEvenLight));
  EXPECT_FALSE(deservesTexture(departure(h.grid, h.light), 0.05, 1000));
}

TEST(Choice, ADarkSurfaceDoesNot) {
  const Histogram h({});
  EXPECT_FALSE(deservesTexture(departure(h.grid, h.light), 0.05, 0));
}

}  // namespace
}  // namespace deltalux
