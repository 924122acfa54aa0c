#include "caustics/resolution.hpp"

#include <gtest/gtest.h>

#include "caustics/surface_impacts.hpp"
#include "caustics/synthetic.hpp"

namespace deltalux {
using namespace caustics;

namespace {

TEST(Resolution, SquareTexelsAreSquareAndWithinTheLimit) {
  EXPECT_EQ(squareTexels({2, 1}, 0.01, 1 << 18), glm::ivec2(20, 10));
  for (const glm::dvec2 size : {glm::dvec2(1, 1), glm::dvec2(100, 0.01), glm::dvec2(1e-3, 50)}) {
    const glm::ivec2 texels = squareTexels(size, 1e-12, 1000);
    EXPECT_LE(texels.x * texels.y, 1000);
    EXPECT_GE(std::min(texels.x, texels.y), 1);
  }
}

TEST(Resolution, TexelsFollowTheDensityWhereTheLightIs) {
  // 70 % of 20,000 in a disc of area 0.045: the flux-weighted mean density is close to 0.7 of the disc's.
  const Shape square = test::unitSquare();
  const Charts charts = chartsOf(square);
  const ChartSurface surface(square, charts, 0);
  const auto impacts = test::drawImpacts(20000, 1, test::discInEvenLight);
  const ChartPart part = surface.whole({64, 64}, placeImpacts(square, charts, impacts)[0]);
  const double inDisc = 0.3 + 0.7 / (kPi * 0.0144), inside = 0.7 + 0.3 * kPi * 0.0144;
  const double typical = 20000 * (inside * inDisc + (1 - inside) * 0.3);
  EXPECT_NEAR(texelArea(part, 1), 1 / typical, 0.1 / typical);
  EXPECT_NEAR(texelArea(part, 5), 5 * texelArea(part, 1), 1e-12);
}

}  // namespace
}  // namespace deltalux
