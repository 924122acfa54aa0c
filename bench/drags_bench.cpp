// drags_bench columns
// drags_bench NAME SCENE LIST.txt METRES
//
// Things dragged as a hand does, as CSV rows (columns: kColumns), one a thing: ten from all over a list of edits
// (edit_list.hpp), each 30 frames there and 30 back, by a fifteenth of the list's step each; a frame is given 33 ms.
// `select_ms`: picking it up; `rest_ms`: the update when the hand rests, after which all light is the fresh solve's.
// METRES: a unit of the scene.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/memory.hpp>
#include <stdexcept>

#include "edit_list.hpp"
#include "run_main.hpp"
#include "stopwatch.hpp"

namespace deltalux::bench {
namespace {

constexpr const char* kColumns =
    "scene,object,frames,frame_median_ms,frame_p95_ms,frame_worst_ms,within_40_ms_percent,select_ms,rest_ms,solve_ms";
constexpr double kFrameMs = 33, kLateMs = 40;
constexpr std::size_t kThings = 10;
constexpr int kFramesOut = 30;
constexpr double kStepShare = 1.0 / 15;

double milliseconds(const Stopwatch& watch) { return 1e3 * watch.wall(); }

/// `move` with its translation scaled.
TransformObject slower(TransformObject move, double share) {
  for (int axis = 0; axis < 3; ++axis) move.matrix[3][axis] *= share;
  return move;
}

void drag(const std::string& scene, Engine& engine, const TransformObject& move, double solveMs) {
  Stopwatch picking;
  engine.select(move.object);
  const double select = milliseconds(picking);
  std::vector<double> frames;
  for (int i = 0; i < 2 * kFramesOut; ++i) {
    const Stopwatch watch;
    engine.apply(slower(move, i < kFramesOut ? kStepShare : -kStepShare));
    engine.frame(kFrameMs);
    frames.push_back(milliseconds(watch));
  }
  const Stopwatch resting;
  engine.update();
  const double rest = milliseconds(resting);
  std::ranges::sort(frames);
  const auto inTime = std::ranges::count_if(frames, [](double ms) { return ms <= kLateMs; });
  fmt::print("{},{},{},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.0f},{:.0f}\n", scene, move.object, frames.size(),
             frames[frames.size() / 2], frames[frames.size() * 95 / 100], frames.back(),
             100 * static_cast<double>(inTime) / static_cast<double>(frames.size()), select, rest, solveMs);
  std::fflush(stdout);
}

int run(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"columns"}) {
    fmt::print("{}\n", kColumns);
    return 0;
  }
  if (words.size() != 4) throw std::runtime_error("usage: drags_bench columns | NAME SCENE LIST.txt METRES");
  ImportSettings import;
  import.metresPerUnit = std::stod(words[3]);
  Scene scene = loadScene({words[1]}, import).scene;
  addAreaLights(scene);
  const EditPhase moves = movesSpread(loadEditList(words[2], scene), kThings);
  const Stopwatch watch;
  Engine engine(std::move(scene));
  engine.solve();
  const double solveMs = milliseconds(watch);
  for (const NamedEdit& edit : moves.edits) drag(words[0], engine, std::get<TransformObject>(edit.edit), solveMs);
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  return deltalux::bench::runMain("drags_bench", argc, argv, deltalux::bench::run);
}
