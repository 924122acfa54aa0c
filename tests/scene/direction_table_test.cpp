#include <gtest/gtest.h>

#include <deltalux/material.hpp>

namespace deltalux {
namespace {

/// 1 + cos(polar) / 2 + sin(polar) cos(azimuth) / 4.
double smooth(const Vec3& w) { return 1 + 0.5 * w.z + 0.25 * w.x; }

DirectionTable tableOf(std::size_t rows, std::size_t columns) {
  DirectionTable table{rows, columns, {}};
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double theta = kPi * double(row) / double(rows - 1), phi = 2 * kPi * double(column) / double(columns);
      table.values.push_back(float(smooth(
          {columns > 1 ? std::sin(theta) * std::cos(phi) : 0, std::sin(theta) * std::sin(phi), std::cos(theta)})));
    }
  return table;
}

TEST(DirectionTable, InterpolatesAndIntegrates) {
  const DirectionTable table = tableOf(91, 180);
  for (const Vec3 w : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, -1e-9, 0), Vec3(1, 2, 3), Vec3(-1, -0.01, 0.2)})
    EXPECT_NEAR(valueAt(table, glm::normalize(w)), smooth(glm::normalize(w)), 1e-3);
  EXPECT_NEAR(integral(table), 4 * kPi, 4e-3);
  EXPECT_NEAR(integral(tableOf(91, 1)), 4 * kPi, 4e-3);
}

TEST(EmissionPattern, TurnsWithItsSurface) {
  Emission emission{
      Rgb(1.0f),
      false,
      {},
      EmissionPattern{std::make_shared<const DirectionTable>(tableOf(91, 180)), glm::dmat3(1.0), 2, Vec3(0, 0, 1)}};
  const Vec3 w = glm::normalize(Vec3(1, 2, 3));
  const double before = relativeRadiance(emission, w, 1);
  EXPECT_NEAR(before, 2 * smooth(w) / w.z, 1e-2);
  const glm::dmat3 quarter(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  const glm::dmat3 over(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0));
  const glm::dmat3 by = over * quarter;
  turn(emission, 3.0 * by);
  EXPECT_NEAR(relativeRadiance(emission, by * w, 1), before, 1e-9);
  EXPECT_LT(glm::distance(*emission.pattern->normal, by * Vec3(0, 0, 1)), 1e-12);
}

}  // namespace
}  // namespace deltalux
