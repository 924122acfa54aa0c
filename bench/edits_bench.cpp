// edits_bench columns
// edits_bench NAME SCENE LIST.txt OPTIONS...
//
// What updates cost over a population of edits (edit_list.hpp), as CSV rows (columns: kColumns). The scene is solved
// once; each edit comes unannounced, and is timed until the solution has followed. Nothing is put back: what the next
// edit meets is the scene as the last has left it. After each phase of edits the solution is held against a fresh solve
// of the edited scene. Times are wall seconds.
//
//   edit: one edit; `edits` counts them.
//
//   check: after a phase (with `once`, after the last alone); `solve_s` of the fresh solve, and by how much irradiance
//   at points differs from it.
//
//   median, p90, worst: over the edits of a kind, of which there are `edits`; each column by itself, and the name of
//   the edit that takes so long.
//
// leaves_changed may exceed leaves_of_solve where moved shadows split leaves: old and new ones are counted.
// Options: metres=M (of a scene unit), error=E, first=N (of each kind, not all), spread=N (moves alone, N of them from
// all over the list), copies=K (of the scene, side by side: the first is edited), once, unchecked, by-light (solved
// with the light of each lamp apart, of which lamps alone are dimmed and switched off: kinds "dim by light" and so on).
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deltalux/check.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/memory.hpp>
#include <limits>
#include <map>
#include <stdexcept>

#include "edit_list.hpp"
#include "scene_copies.hpp"
#include "stopwatch.hpp"

namespace deltalux::bench {
namespace {

constexpr const char* kColumns =
    "row,scene,error,kind,subject,edits,solve_s,update_s,solve_over_update,rays,leaves_changed,leaves_of_solve,"
    "particles_retraced,particles_total,textures_rebuilt,median_percent,p95_percent,max_percent,mesh_identical,lines_"
    "identical,particles_identical";

struct Options {
  ImportSettings import;
  SolveSettings solve;
  std::size_t first = std::numeric_limits<std::size_t>::max();
  std::size_t spread = 0;
  int copies = 1;
  bool checked = true, once = false, byLight = false;

  static Options parse(const std::vector<std::string>& words) {
    Options o;
    for (const std::string& word : words) {
      if (word.starts_with("metres="))
        o.import.metresPerUnit = std::stod(word.substr(7));
      else if (word.starts_with("error="))
        o.solve.error = std::stod(word.substr(6));
      else if (word.starts_with("first="))
        o.first = std::stoul(word.substr(6));
      else if (word.starts_with("spread="))
        o.spread = std::stoul(word.substr(7));
      else if (word.starts_with("copies="))
        o.copies = std::stoi(word.substr(7));
      else if (word == "once")
        o.once = true;
      else if (word == "unchecked")
        o.checked = false;
      else if (word == "by-light")
        o.byLight = o.solve.byLight = true;
      else
        throw std::runtime_error("no option '" + word + "'");
    }
    return o;
  }
};

/// One edit, measured.
struct Cost {
  std::string subject;
  double seconds = 0;
  StepReport step;
};

struct Solved {
  Engine engine;
  double seconds = 0;
};

Solved solve(Scene scene, const SolveSettings& settings) {
  const Stopwatch watch;
  Engine engine(std::move(scene), settings);
  engine.solve();
  return {std::move(engine), watch.wall()};
}

class Table {
 public:
  /// Of the first solve.
  Table(std::string scene, double error, double seconds, std::uint64_t leaves)
      : scene_(std::move(scene)), error_(error), solve_(seconds), leaves_(leaves) {}

  void edit(const NamedEdit& edit, Cost cost) {
    print("edit", edit.kind, ++edits_, cost);
    if (!costs_.contains(edit.kind)) kinds_.push_back(edit.kind);
    costs_[edit.kind].push_back(std::move(cost));
  }

  void check(const std::string& phase, const CheckReport& c) const {
    const auto word = [](bool identical) { return identical ? "yes" : "no"; };
    fmt::print("check,{},{},{},,{},{:.4g},,,,,,,,,{:.3g},{:.3g},{:.3g},{},{},{}\n", scene_, error_, phase, edits_,
               c.solveS, 100 * c.medianRelDiff, 100 * c.p95RelDiff, 100 * c.maxRelDiff, word(c.meshIdentical),
               word(c.linesIdentical), word(c.particlesIdentical));
    std::fflush(stdout);
  }

  void summaries() const {
    for (const std::string& kind : kinds_)
      for (const auto& [name, share] : {std::pair("median", 0.5), {"p90", 0.9}, {"worst", 1.0}})
        print(name, kind, costs_.at(kind).size(), quantile(costs_.at(kind), share));
  }

 private:
  /// The least that so large a share of them does not exceed, of each figure by itself.
  static Cost quantile(std::vector<Cost> costs, double share) {
    const double rank = std::ceil(share * static_cast<double>(costs.size()));
    const std::size_t at = static_cast<std::size_t>(rank) - 1;
    const auto ranked = [&](auto&& figure) {
      std::ranges::nth_element(costs, costs.begin() + static_cast<std::ptrdiff_t>(at), {}, figure);
      return costs[at];
    };
    Cost q = ranked(&Cost::seconds);
    for (std::uint64_t StepReport::*figure :
         {&StepReport::rays, &StepReport::leavesChanged, &StepReport::particlesRetraced, &StepReport::particlesTotal,
          &StepReport::texturesRebuilt})
      q.step.*figure = ranked([&](const Cost& c) { return c.step.*figure; }).step.*figure;
    return q;
  }

  void print(const char* row, const std::string& kind, std::size_t edits, const Cost& c) const {
    fmt::print("{},{},{},{},{},{},{:.4g},{:.4g},{:.4g},", row, scene_, error_, kind, c.subject, edits, solve_,
               c.seconds, solve_ / c.seconds);
    fmt::print("{},{},{},{},{},{},,,,,,\n", c.step.rays, c.step.leavesChanged, leaves_, c.step.particlesRetraced,
               c.step.particlesTotal, c.step.texturesRebuilt);
    std::fflush(stdout);
  }

  std::string scene_;
  double error_, solve_;
  std::uint64_t leaves_;
  std::size_t edits_ = 0;
  std::vector<std::string> kinds_;  // in order of appearance
  std::map<std::string, std::vector<Cost>> costs_;
};

Cost measure(Engine& engine, const NamedEdit& edit) {
  const Stopwatch watch;
  engine.apply(edit.edit);
  StepReport step = engine.update();
  return {edit.subject, watch.wall(), std::move(step)};
}

/// Of the edits those that but dim lamps.
std::vector<EditPhase> dimmingAlone(std::vector<EditPhase> phases) {
  for (EditPhase& phase : phases) {
    std::erase_if(phase.edits, [](const NamedEdit& e) { return e.kind != "dim" && e.kind != "off" && e.kind != "on"; });
    for (NamedEdit& e : phase.edits) e.kind += " by light";
  }
  return phases;
}

CheckReport check(const Engine& engine) {
  const Solved fresh = solve(engine.solution().scene(), engine.solution().settings());
  CheckReport report = compareSolutions(engine.solution(), fresh.engine.solution());
  report.solveS = fresh.seconds;
  return report;
}

void run(const std::string& name, const std::string& file, const std::string& list, const Options& o) {
  Scene scene = loadScene({file}, o.import).scene;
  addAreaLights(scene);
  std::vector<EditPhase> phases = loadEditList(list, scene);
  if (o.spread > 0) phases = {movesSpread(phases, o.spread)};
  if (o.byLight) phases = dimmingAlone(std::move(phases));
  if (o.copies > 1) scene = sideBySide(scene, o.copies);
  Solved solved = solve(std::move(scene), o.solve);
  Table table(name, o.solve.error, solved.seconds, solved.engine.solution().report().counts.leafElements);
  for (const EditPhase& phase : phases) {
    std::map<std::string, std::size_t> done;  // by kind
    for (const NamedEdit& edit : phase.edits)
      if (done[edit.kind]++ < o.first) table.edit(edit, measure(solved.engine, edit));
    const bool due = o.once ? &phase == &phases.back() : !phase.edits.empty();
    if (o.checked && due) table.check(phase.name, check(solved.engine));
  }
  table.summaries();
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 1 && words[0] == "columns") {
      fmt::print("{}\n", deltalux::bench::kColumns);
      return 0;
    }
    if (words.size() >= 3) {
      deltalux::bench::run(words[0], words[1], words[2],
                           deltalux::bench::Options::parse({words.begin() + 3, words.end()}));
      return 0;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "edits_bench: {}\n", error.what());
    return 1;
  }
  std::fputs(
      "usage: edits_bench columns\n"
      "       edits_bench NAME SCENE LIST.txt OPTIONS...\n"
      "options: metres=M, error=E, first=N, spread=N, copies=K, once, unchecked, by-light\n",
      stderr);
  return 2;
}
