#pragma once
// A solution to give away: one html file that anyone can open, walk in, and dim the lights of (docs/export.md).
#include <cstdint>
#include <deltalux/probe.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>
#include <deltalux/view.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltalux {

/// Points that Em, Emin, U0 and Ud are told of together.
struct PageGrid {
  std::string name;
  std::vector<ProbePoint> points;  // in the scene's own coordinates; at least one
};

struct PageSettings {
  std::string title = "solution";
  std::vector<View> views;      // beside the scene's own, in its coordinates; those that are parallel are left out
  std::vector<PageGrid> grids;  // measured for each group of lights, as probe() does
  std::optional<double> ev;     // exposure that the page opens with [stops]; by itself: of its first view
  double meterError = 0.0125;   // standard error of a point, over all light there, in (0, 1)
  int meterSamples = 1 << 17;   // lines or shadow rays of a point at most
  std::uint64_t seed = 1;       // of the meters
};

/// Writes the page, atomically. Throws OutputError; InputError where the groups of lights have not one mesh (solve it
/// again); Interrupted. Cost: a reading of the solution for each group of lights (light_groups.hpp), and their meters.
void exportPage(const SolutionView&, const std::filesystem::path&, const PageSettings& = {},
                Progress* progress = nullptr);

}  // namespace deltalux
