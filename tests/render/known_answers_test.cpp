// Bundled scenes whose answers are known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

#include "support/shared.hpp"

namespace deltalux {
namespace {

std::vector<ProbeResult> probe(const std::string& scene, const std::vector<ProbePoint>& points, std::uint64_t samples) {
  const ImportedScene imported = loadScene({test::sourceFolder() / "scenes" / scene});
  ReferenceSettings settings;
  settings.samples = samples;
  return ReferenceIntegrator(imported.scene, settings).probe(points);
}

/// Configuration factor from a point to a rectangle a x b in a plane at distance c, one corner of which is the point's
/// foot: the plane parallel to the point's surface, and at right angles to it (a then leads away from the point).
double parallelFactor(double a, double b, double c) {
  const double p = std::hypot(a, c), q = std::hypot(b, c);
  return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * kPi);
}
double perpendicularFactor(double a, double b, double c) {
  const double p = std::hypot(a, c);
  return (std::atan(b / c) - c / p * std::atan(b / p)) / (2 * kPi);
}

/// Cell centres of an n x n grid over the parallelogram.
std::vector<ProbePoint> grid(const Vec3& origin, const Vec3& edgeU, const Vec3& edgeV, const Vec3& normal, int n) {
  std::vector<ProbePoint> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) points.push_back({origin + (i + 0.5) / n * edgeU + (j + 0.5) / n * edgeV, normal});
  return points;
}

/// Every point within five standard errors, and the mean of all, which is far more exact, within four of its own.
template <class Expected>
void expectIrradiance(const std::string& scene, const std::vector<ProbePoint>& points, const Expected& expected) {
  const std::vector<ProbeResult> results = probe(scene, points, 4096);
  double difference = 0, variance = 0, sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double E = expected(points[i].position), error = results[i].standardError.g;
    EXPECT_NEAR(results[i].irradiance.g, E, 5 * error) << i;
    difference += results[i].irradiance.g - E;
    variance += error * error;
    sum += E;
  }
  EXPECT_LT(std::sqrt(variance), 5e-4 * sum);
  EXPECT_NEAR(difference, 0.0, 4 * std::sqrt(variance));
}

TEST(KnownAnswers, ParallelPlates) {
  const auto expected = [](const Vec3& p) {
    double factor = 0;
    for (const double a : {p.x, 1 - p.x})
      for (const double b : {p.y, 1 - p.y}) factor += parallelFactor(a, b, 1);
    return kPi * factor;
  };
  expectIrradiance("plates/parallel.rad", grid({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, 8), expected);
}

TEST(KnownAnswers, PerpendicularPlates) {
  const auto expected = [](const Vec3& p) {
    return kPi * (perpendicularFactor(1, p.y, p.z) + perpendicularFactor(1, 1 - p.y, p.z));
  };
  expectIrradiance("plates/perpendicular.rad", grid({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 8), expected);
}

TEST(KnownAnswers, SealedBoxesLeakNothing) {
  const std::vector<ProbePoint> outside{{{0.5, 0.5, 1}, {0, 0, 1}}};
  const double E = probe("nasty/sealed.rad", outside, 256)[0].irradiance.g;
  EXPECT_GT(E, 0.05);
  std::vector<ProbePoint> inside;
  for (const double z : {1e-4, 0.5, 1 - 1e-4})
    for (const double x : {1e-4, 0.5, 1 - 1e-4})
      for (const Vec3 n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0)})
        inside.push_back({{x, 0.5, z}, n});
  // Single precision: of the paths that bounce 0.1 mm from an edge, one in some ten thousand starts beyond it.
  for (const ProbeResult& r : probe("nasty/sealed.rad", inside, 4096)) EXPECT_LT(r.irradiance.g, 1e-4 * E);
}

TEST(KnownAnswers, TheRingsCausticIsACardioid) {
  // Seen from above the lamp stands on the circle of radius r at angle pi. A ray to the wall at angle a comes in at
  // i = a / 2 to the normal and, reflected, touches the envelope a third of its way on: the cardioid, a bright line
  // with light on its concave side only.
  constexpr double r = 0.05;
  std::vector<ProbePoint> points;
  for (const double a : {0.5, 0.9, 1.3, 1.7}) {
    const glm::dvec2 lamp(-r, 0), wall(r * std::cos(a), r * std::sin(a));
    const glm::dvec2 normal = -wall / r, incoming = glm::normalize(wall - lamp);
    const glm::dvec2 reflected = glm::reflect(incoming, normal);
    const glm::dvec2 touch = wall + glm::length(wall - lamp) / 3.0 * reflected;
    glm::dvec2 across(-reflected.y, reflected.x);
    if (glm::dot(across, touch - glm::dvec2(-r / 3, 0)) > 0) across = -across;  // towards the dark middle
    for (const double offset : {0.0, 0.004}) {
      const glm::dvec2 p = touch + offset * across;
      points.push_back({{p.x, p.y, 0}, {0, 0, 1}});
    }
  }
  const std::vector<ProbeResult> results = probe("ring/ring.rad", points, 65536);
  for (std::size_t i = 0; i < results.size(); i += 2) {
    const double onLine = results[i].irradiance.g, within = results[i + 1].irradiance.g;
    const double error = results[i].standardError.g + results[i + 1].standardError.g;
    EXPECT_GT(onLine - 3 * error, 1.5 * within) << i;
  }
}

}  // namespace
}  // namespace deltalux
