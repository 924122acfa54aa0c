// paper_bench columns
// paper_bench approach NAME SCENE ERROR...
// paper_bench follow NAME SCENE EDITS.json ERROR
//
// The paper's method (--method paper) as CSV rows.
// approach: solutions over links at each error against one over lines at half of the least of them: irradiance at 2000
// points by area, all that arrives, and the ledger's residue, in per cent; links; seconds.
// follow: after each edit its time, links of the line space, particles emitted again, bytes of the octree, and
// irradiance against a fresh solve of the scene as it is then.
#include <fmt/format.h>

#include <cstdio>
#include <deltalux/check.hpp>
#include <deltalux/edit_io.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/memory.hpp>
#include <stdexcept>

#include "run_main.hpp"
#include "stopwatch.hpp"
#include "support/residue.hpp"
#include "support/solved.hpp"

namespace deltalux::bench {
namespace {

constexpr const char* kColumns = "scene,error,step,measure,value,unit";
constexpr CheckSettings kCheck{2000, 0.005};

struct Table {
  std::string scene, error, step;

  void row(const char* measure, double value, const char* unit) const {
    fmt::print("{},{},{},{},{:.5g},{}\n", scene, error, step, measure, value, unit);
    std::fflush(stdout);
  }
  void difference(const CheckReport& check) const {
    row("median difference", 100 * check.medianRelDiff, "%");
    row("95th percentile", 100 * check.p95RelDiff, "%");
  }
};

Scene sceneOf(const std::string& file) { return loadScene({file}).scene; }

int approach(const std::vector<std::string>& words) {
  double least = 1;
  for (std::size_t i = 3; i < words.size(); ++i) least = std::min(least, std::stod(words[i]));
  const Engine lines = test::solved(sceneOf(words[2]), 0.5 * least);
  for (std::size_t i = 3; i < words.size(); ++i) {
    const Table table{words[1], words[i], "solve"};
    const Stopwatch watch;
    const Engine links = test::solved(sceneOf(words[2]), std::stod(words[i]), SolveMethod::Paper);
    table.row("time", watch.wall(), "s");
    table.row("links", static_cast<double>(links.solution().report().counts.links), "");
    table.row("residue of the ledger", 100 * test::residue(links.solution().report().energy), "%");
    table.row("arriving", 100 * (test::arrivingPower(links) / test::arrivingPower(lines) - 1), "% of lines'");
    table.difference(compareSolutions(links.solution(), lines.solution(), kCheck));
  }
  return 0;
}

int follow(const std::vector<std::string>& words) {
  const double error = std::stod(words[4]);
  Engine engine = test::solved(sceneOf(words[2]), error, SolveMethod::Paper);
  Table table{words[1], words[4], "solve"};
  table.row("time", engine.solution().report().times.total, "s");
  int count = 0;
  for (const EditStep& edit : loadEdits(words[3])) {
    if (!std::holds_alternative<Edit>(edit)) throw std::runtime_error("paper_bench: plain edits alone");
    const Stopwatch watch;
    engine.apply(std::get<Edit>(edit));
    const StepReport step = engine.update();
    table.step = fmt::format("{} {} {}", ++count, step.op, step.object);
    table.row("time", watch.wall(), "s");
    table.row("links visited", static_cast<double>(step.linksVisited), "");
    table.row("links changed", static_cast<double>(step.linksChanged), "");
    table.row("particles emitted again", static_cast<double>(step.particlesRetraced), "");
    if (step.particlesTotal > 0)
      table.row("of all",
                100.0 * static_cast<double>(step.particlesRetraced) / static_cast<double>(step.particlesTotal), "%");
    table.row("octree", static_cast<double>(engine.solution().report().memory.octree), "bytes");
    table.row("residue of the ledger", 100 * test::residue(engine.balance()), "%");
    const Engine fresh = test::solved(engine.solution().scene(), error, SolveMethod::Paper);
    const CheckReport check = compareSolutions(engine.solution(), fresh.solution(), kCheck);
    table.difference(check);
    table.row("the fresh solve's particles", check.particlesIdentical, "");
  }
  return 0;
}

int run(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"columns"}) {
    fmt::print("{}\n", kColumns);
    return 0;
  }
  if (words.size() > 3 && words[0] == "approach") return approach(words);
  if (words.size() == 5 && words[0] == "follow") return follow(words);
  throw std::runtime_error(
      "usage: paper_bench columns | approach NAME SCENE ERROR... | follow NAME SCENE EDITS.json ERROR");
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  return deltalux::bench::runMain("paper_bench", argc, argv, deltalux::bench::run);
}
