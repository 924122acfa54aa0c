// line_copies_bench NAME SCENE K
//
// A solve over lines of k copies of a scene side by side, as a CSV row: scene, copies, lamps, seconds, processor
// seconds, leaves, lines, rays of visibility, and peak memory [MB]. One solve a run, so that the memory is its own.
#include <fmt/format.h>

#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <stdexcept>

#include "processor_time.hpp"
#include "run_main.hpp"
#include "scene_copies.hpp"

namespace deltalux::bench {
namespace {

int run(const std::vector<std::string>& a) {
  const int copies = a.size() == 3 ? std::atoi(a[2].c_str()) : 0;
  if (copies < 1) throw std::runtime_error("usage: line_copies_bench NAME SCENE K");
  Scene scene = sideBySide(loadScene({a[1]}).scene, copies);
  const std::size_t lamps = scene.lights.size();
  SolveSettings settings;
  const double before = processorSeconds();
  Engine engine(std::move(scene), settings);
  const SolveReport report = engine.solve();
  fmt::print("{},{},{},{:.4g},{:.4g},{},{},{},{:.4g}\n", a[0], copies, lamps, report.times.total,
             processorSeconds() - before, report.counts.leafElements, report.counts.lines, report.counts.raysVisibility,
             static_cast<double>(peakResidentBytes()) / 1e6);
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  return deltalux::bench::runMain("line_copies_bench", argc, argv, deltalux::bench::run);
}
