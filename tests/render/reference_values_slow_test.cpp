// The reference integrator against independent values: at least 98 % within three combined standard errors. Prints a
// table per file and region. DELTALUX_REFERENCE_SAMPLES sets the paths per probe.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>
#include <ostream>

#include "support/reference_values.hpp"
#include "support/shared.hpp"

namespace deltalux {
namespace {

using namespace test;

struct Comparison {
  const char* name;
  const char* scene;  // in the shared folder
  const char* values;
  bool diffuseOnly;
  std::uint64_t samples;

  friend void PrintTo(const Comparison& c, std::ostream* out) { *out << c.name; }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

class ReferenceValues : public testing::TestWithParam<Comparison> {};

TEST_P(ReferenceValues, AgreeWithinThreeStandardErrors) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const Comparison& c = GetParam();
  const auto expected = readReferenceValues(shared / "reference" / c.values);
  ASSERT_GT(expected.size(), 200u);
  std::vector<ProbePoint> points;
  for (const ReferenceValue& v : expected) points.push_back(v.point);
  ReferenceSettings settings;
  const char* samples = std::getenv("DELTALUX_REFERENCE_SAMPLES");
  settings.samples = samples ? std::strtoull(samples, nullptr, 10) : c.samples;
  settings.diffuseOnly = c.diffuseOnly;
  ReferenceIntegrator integrator(loadScene({shared / c.scene}).scene, settings);
  const auto measured = integrator.probe(points);
  std::vector<double> relative, theirs;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    relative.push_back(measured[i].standardError.g / measured[i].irradiance.g);
    theirs.push_back(expected[i].standardError.g / expected[i].irradiance.g);
  }
  const ReferenceStats stats = integrator.stats();
  fmt::print("{}: {} paths per probe, {:.1f} s, {:.2f} Mrays/s, median standard error {:.2f} % (theirs {:.2f} %)\n",
             c.name, measured[0].samples, stats.seconds, static_cast<double>(stats.rays) / stats.seconds / 1e6,
             100 * median(relative), 100 * median(theirs));
  fmt::print("{:>16} {:>7} {:>10} {:>8} {:>8} {:>10}\n", "region", "values", "within 3", "mean z", "rms z",
             "mean dE/E");
  const auto agreement = compare(expected, measured);
  for (const auto& [region, a] : agreement) {
    fmt::print("{:>16} {:>7} {:>9.2f}% {:>8.3f} {:>8.3f} {:>9.3f}%\n", region, a.values, 100 * a.fraction(), a.meanZ(),
               a.rmsZ(), 100 * a.sumRelative / a.values);
  }
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double error = std::hypot(expected[i].standardError.g, measured[i].standardError.g);
    const double z = (measured[i].irradiance.g - expected[i].irradiance.g) / error;
    if (std::abs(z) <= 4) continue;
    fmt::print(
        "  probe {} {} at ({:.3f} {:.3f} {:.3f}) facing ({:.2f} {:.2f} {:.2f}): {:.5g} +- {:.2g}, expected {:.5g} +- "
        "{:.2g}\n",
        i, expected[i].region, points[i].position.x, points[i].position.y, points[i].position.z, points[i].normal.x,
        points[i].normal.y, points[i].normal.z, measured[i].irradiance.g, measured[i].standardError.g,
        expected[i].irradiance.g, expected[i].standardError.g);
  }
  EXPECT_GE(agreement.at("all").fraction(), 0.98);
  // Means of many values tell a bias that single ones hide.
  EXPECT_LT(std::abs(agreement.at("all").meanZ()), 0.25);
}

INSTANTIATE_TEST_SUITE_P(Shared, ReferenceValues,
                         testing::Values(Comparison{"cornell", "reference/cornell.rad", "cornell.csv", false, 8192},
                                         Comparison{"mirror_caustic", "reference/cornell-mirror-caustic.rad",
                                                    "cornell-mirror-caustic.csv", false, 65536},
                                         Comparison{"cabin", "scenes/cabin/cabin.rad", "cabin.csv", false, 4096},
                                         Comparison{"cabin_diffuse", "scenes/cabin/cabin.rad", "cabin-diffuse.csv",
                                                    true, 4096}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace deltalux
