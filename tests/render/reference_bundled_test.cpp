// The bundled scenes whose answers are known exactly: the glTF furnace and the two pairs of plates.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

#include "base/sobol.hpp"
#include "support/shared.hpp"

namespace deltalux {
namespace {

std::vector<ProbeResult> measure(const char* file, const std::vector<ProbePoint>& points, std::uint64_t samples) {
  ReferenceSettings settings;
  settings.samples = samples;
  return ReferenceIntegrator(loadScene({test::sourceFolder() / "scenes" / file}).scene, settings).probe(points);
}

TEST(ReferenceBundled, FurnaceIsTwoPiEverywhere) {
  const std::vector<ProbePoint> points = {{{0.2, 0.3, 0}, {0, 0, 1}},
                                          {{0, 0.01, 0.02}, {1, 0, 0}},
                                          {{0.9, 1, 0.4}, {0, -1, 0}},
                                          {{0.4, 0.6, 0.5}, glm::normalize(Vec3(1, -2, 3))}};
  for (const ProbeResult& r : measure("furnace/furnace.gltf", points, 4096)) {
    EXPECT_NEAR(r.irradiance.g, 2 * kPi, 4.5 * r.standardError.g);
    EXPECT_LT(r.standardError.g, 0.02 * 2 * kPi);
  }
}

/// Mean irradiance of a unit square: stratified points, so the error is far below that of independent ones.
double meanOver(const char* file, const Vec3& origin, const Vec3& u, const Vec3& v, const Vec3& normal) {
  std::vector<ProbePoint> points;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const UnitPair p = scrambledSobol(i, 11);
    points.push_back({origin + p.x * u + p.y * v, normal});
  }
  double sum = 0;
  for (const ProbeResult& r : measure(file, points, 64)) sum += r.irradiance.g;
  return sum / static_cast<double>(points.size());
}

TEST(ReferenceBundled, PlatesGetTheirFormFactor) {
  const double parallel =
      2 / kPi * (std::log(2 / std::sqrt(3)) + 2 * std::sqrt(2) * std::atan(1 / std::sqrt(2)) - kPi / 2);
  EXPECT_NEAR(meanOver("plates/parallel.rad", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}) / (kPi * parallel), 1,
              0.002);
  const double perpendicular = (kPi / 2 - std::sqrt(2) * std::atan(1 / std::sqrt(2)) + std::log(0.75) / 4) / kPi;
  EXPECT_NEAR(meanOver("plates/perpendicular.rad", Vec3(0), {0, 1, 0}, {0, 0, 1}, {1, 0, 0}) / (kPi * perpendicular), 1,
              0.002);
}

}  // namespace
}  // namespace deltalux
