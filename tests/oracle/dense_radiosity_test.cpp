// The oracle itself, against closed forms.
#include "oracle/dense_radiosity.hpp"

#include <gtest/gtest.h>

#include "support/rooms.hpp"

namespace deltalux::test {
namespace {

TEST(DenseOracle, FurnaceIsItsClosedForm) {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f), Emission{Rgb(1.0f), false, {}}), Vec3(0), {1, 1.5, 0.8},
         true);
  const OracleSolution s = solveDense(scene);
  EXPECT_EQ(s.patches.size(), 2u * (2 * 3 + 3 * 2 + 2 * 2));
  for (std::size_t i = 0; i < s.patches.size(); ++i) {
    EXPECT_NEAR(s.rowSums[i], 1, 5e-4);  // exact before the two ways are averaged
    EXPECT_NEAR(s.irradiance[i], 2 * kPi, 3e-3);
  }
}

TEST(DenseOracle, ParallelPlatesMatchTheirClosedForm) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(1.0f), false, {}}),
             {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  addPolygon(scene, addMaterial(scene, "floor", lambert(0.5f)), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const OracleSolution s = solveDense(scene);
  double mean = 0;
  for (std::size_t i = 0; i < s.patches.size(); ++i)
    if (s.patches[i].primitive == PrimitiveId(1)) mean += s.irradiance[i] * s.patches[i].area;
  EXPECT_NEAR(mean / kPi, 0.199825, 2e-4);  // Howell C-11
}

TEST(DenseOracle, ABlockTakesWhatItHides) {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.5f));
  addBox(scene, grey, Vec3(0), {2, 2, 2}, true);
  addBox(scene, grey, {0.7, 0.7, 0.5}, {1.3, 1.3, 1}, false);
  const OracleSolution s = solveDense(scene);
  double worst = 0, mean = 0;
  for (const double sum : s.rowSums) worst = std::max(worst, std::abs(sum - 1)), mean += sum;
  EXPECT_NEAR(mean / static_cast<double>(s.rowSums.size()), 1, 0.005);
  EXPECT_LT(worst, 0.06);
}

}  // namespace
}  // namespace deltalux::test
