#pragma once
// What a solve of a daylight case is held to.
#include <gtest/gtest.h>

#include "support/cie171/cases.hpp"
#include "support/solved.hpp"

namespace deltalux::test::cie171 {

/// Solves the case at such an error, with ground and masks in tiles, and expects readings within it, but for three
/// standard errors of the readings themselves; in the mean within half of it.
inline void expectDaylight(const Daylight& d, int sky, double error) {
  constexpr double kSureness = 3;
  constexpr std::uint64_t kParticles = 20000;  // behind glass, where they bring the ground what panes reflect
  Case c = daylightCase(d, sky);
  cutIntoTiles(c, d);
  SolveSettings settings;
  settings.error = error, settings.particles = kParticles;
  Engine engine(c.scene, settings);
  engine.solve();
  const std::vector<ProbeResult> readings = measure(engine, c.points);
  const std::vector<double> errors = relativeErrors(c, readings);
  double mean = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double noise = kLuminousEfficacy * readings[i].standardError.g / std::max(c.expected[i], 1e-9);
    EXPECT_LT(errors[i], error + kSureness * noise)
        << d.name << " " << d.variant << ", sky " << sky << ", point " << i << ", expected " << c.expected[i] << " lx";
    mean += errors[i] / double(errors.size());
  }
  EXPECT_LT(mean, error / 2) << d.name << " " << d.variant << ", sky " << sky;
}

}  // namespace deltalux::test::cie171
