#include "caustics/low_frequency_layer.hpp"

#include <gtest/gtest.h>

#include "caustics/adaptive_textures.hpp"
#include "caustics/synthetic.hpp"

namespace deltalux {
using namespace caustics;

namespace {

/// Root mean square step of E over the borders of the fine textures, relative to `E`.
double stepOverBorders(const SurfaceCaustics& s, double E) {
  constexpr int kPoints = 64;
  constexpr double kBeside = 1e-6;
  double squares = 0;
  int count = 0;
  for (const CausticTexture& t : std::span(s.textures).first(s.textures.size() - 1))
    for (int side = 0; side < 4; ++side) {
      const int across = side / 2;
      const double border = side % 2 ? t.region.upper[across] : t.region.lower[across];
      if (border < 0.01 || border > 0.99) continue;  // the surface's own
      for (int i = 0; i < kPoints; ++i) {
        Vec2 at = t.region.lower + (i + 0.5) / kPoints * t.region.size();
        const auto beside = [&](double d) {
          at[across] = border + d;
          return double(s.irradianceAt(test::inSquare(at.x, at.y)).r);
        };
        squares += std::pow((beside(kBeside) - beside(-kBeside)) / E, 2), ++count;
      }
    }
  return count > 0 ? std::sqrt(squares / count) : 1e30;
}

TEST(LowFrequencyLayer, LightDoesNotStepWhereAFineTextureEnds) {
  const auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(20000, 3, test::discInEvenLight), {0.05, 0});
  ASSERT_TRUE(s);
  ASSERT_GT(s->textures.size(), 1u);
  EXPECT_LT(stepOverBorders(*s, 0.3), 0.01);
}

TEST(LowFrequencyLayer, FigureAtTheSurfacesOwnBorderStaysSharpThere) {
  // A disc that the left border halves.
  const auto halfDisc = [](Rng& rng) {
    if (rng.uniform() < 0.3) return test::evenly(rng);
    const double r = 0.2 * std::sqrt(rng.uniform()), phi = kPi * (rng.uniform() - 0.5);
    return test::inSquare(r * std::cos(phi), 0.5 + r * std::sin(phi));
  };
  const auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(40000, 3, halfDisc), {0.05, 0});
  ASSERT_TRUE(s);
  const double exact = 0.3 + 0.7 / (0.5 * kPi * 0.2 * 0.2);
  double sum = 0;
  for (int i = 0; i < 40; ++i) sum += s->irradianceAt(test::inSquare(0.002, 0.4 + 0.005 * i)).r / 40;
  EXPECT_NEAR(sum / exact, 1, 0.03);
}

TEST(LowFrequencyLayer, ChartKeepsItsFlux) {
  const auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(20000, 3, test::discInEvenLight), {0.05, 0});
  ASSERT_TRUE(s);
  RgbSum shown(0.0);
  for (const CausticTexture& t : s->textures) shown += t.integral();
  EXPECT_NEAR(shown.r, 1.0, 1e-5);
  EXPECT_NEAR(shown.g, 0.5, 1e-5);
  EXPECT_NO_THROW(validate(*s));
}

}  // namespace
}  // namespace deltalux
