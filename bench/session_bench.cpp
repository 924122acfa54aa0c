// session_bench EDITS [EVERY]
//
// A long session: so many random edits of a furnished room (tests/support/furnished_room.hpp), an update after each, as
// CSV rows every hundred edits (or EVERY): resident memory, time of the hundred, whether mesh, lines and particles are
// those of a fresh solve of the scene as it is then, and by how much irradiance differs from that.
#include <fmt/format.h>

#include <cstdio>
#include <deltalux/check.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/memory.hpp>
#include <stdexcept>

#include "base/freed_memory.hpp"
#include "run_main.hpp"
#include "stopwatch.hpp"
#include "support/furnished_room.hpp"
#include "support/solved.hpp"

namespace deltalux::bench {
namespace {

constexpr int kUsually = 100;
constexpr std::uint64_t kSeed = 41;

int run(const std::vector<std::string>& words) {
  const int edits = words.empty() ? 0 : std::atoi(words[0].c_str()),
            every = words.size() > 1 ? std::atoi(words[1].c_str()) : kUsually;
  if (edits < 1 || every < 1 || words.size() > 2) throw std::runtime_error("usage: session_bench EDITS [EVERY]");
  fmt::print(
      "edits,seconds,rays,leaves,lines_mb,particles_mb,fresh_seconds,mesh,lines,particles,median_percent,p95_percent,"
      "last,"
      "resident_mb\n");
  Engine engine(test::furnishedRoom(), test::coarse());
  engine.solve();
  test::RandomEdits session(engine, test::editableOfFurnishedRoom(), kSeed);
  std::uint64_t rays = 0;
  double seconds = 0;
  int differing = 0;
  for (int i = 1; i <= edits; ++i) {
    const Stopwatch watch;
    rays += session.step().rays;
    seconds += watch.wall();
    if (i % every != 0 && i != edits) continue;
    const SolveReport report = engine.solution().report();
    const Stopwatch solving;
    Engine fresh(engine.solution().scene(), engine.solution().settings());
    fresh.solve();
    const double solved = solving.wall();
    const CheckReport check = compareSolutions(engine.solution(), fresh.solution());
    differing += !(check.meshIdentical && check.linesIdentical && check.particlesIdentical);
    const std::string last = session.last();
    session.undoAll();
    fmt::print("{},{:.4g},{},{},{:.1f},{:.1f},{:.4g},{},{},{},{:.3g},{:.3g},{},{:.1f}\n", i, seconds, rays,
               report.counts.leafElements, 1e-6 * static_cast<double>(report.memory.lines),
               1e-6 * static_cast<double>(report.memory.particles), solved, check.meshIdentical, check.linesIdentical,
               check.particlesIdentical, 100 * check.medianRelDiff, 100 * check.p95RelDiff, last,
               1e-6 * static_cast<double>(residentBytes()));
    std::fflush(stdout);
    rays = 0, seconds = 0;
  }
  return differing > 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  return deltalux::bench::runMain("session_bench", argc, argv, deltalux::bench::run);
}
