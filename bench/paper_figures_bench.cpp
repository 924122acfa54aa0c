// paper_figures_bench columns
// paper_figures_bench positions NAME SCENE VIEW EDITS.json EV FOLDER
// paper_figures_bench drag NAME SCENE VIEW EDITS.json EV FOLDER
//
// The paper's figures of what moves, as pictures NAME-0.png, NAME-1.png, ... in FOLDER, and what each took as CSV rows.
// positions: before the edits and after each, by the default method. [GD01 figures 7, 9]
// drag: by the paper's method, in motion: each edit in kFrames equal frames that emit a share of the particles again;
// pictures before, in the middle of the first two edits, and after the update in the end. [GD01 figure 5]
#include <fmt/format.h>

#include <cstdio>
#include <deltalux/edit_io.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <deltalux/memory.hpp>
#include <deltalux/render.hpp>
#include <deltalux/view.hpp>
#include <stdexcept>

#include "run_main.hpp"
#include "stopwatch.hpp"

namespace deltalux::bench {
namespace {

constexpr const char* kColumns = "figure,picture,step,seconds,solve_seconds,particles_retraced,particles_total";
constexpr int kFrames = 4;
constexpr int kWidth = 400, kHeight = 320, kSamples = 64;

class Figure {
 public:
  /// NAME SCENE VIEW EDITS EV FOLDER
  Figure(std::span<const std::string> words, const SolveSettings& settings)
      : name_(words[0]),
        view_(loadView(words[2])),
        ev_(std::stod(words[4])),
        folder_(words[5]),
        engine_(loadScene({words[1]}).scene, settings) {
    for (const EditStep& step : loadEdits(words[3])) {
      const Edit* edit = std::get_if<Edit>(&step);
      if (!edit || !std::holds_alternative<TransformObject>(*edit))
        throw std::runtime_error("paper_figures_bench: things that move alone");
      moves_.push_back(std::get<TransformObject>(*edit));
    }
    const Stopwatch watch;
    engine_.solve();
    solve_ = watch.wall();
    picture("solve", solve_, {});
  }

  const std::vector<TransformObject>& moves() const { return moves_; }
  void move(const TransformObject& edit) { engine_.apply(edit); }
  void update(const std::string& step) {
    const Stopwatch watch;
    const StepReport report = engine_.update();
    picture(step, watch.wall(), report);
  }
  /// In motion; a picture where one is wanted.
  void frame(const std::string& step, bool wanted) {
    const Stopwatch watch;
    const StepReport report = engine_.frame(0);
    if (wanted) picture(step, watch.wall(), report);
  }

 private:
  void picture(const std::string& step, double seconds, const StepReport& report) {
    RenderSettings settings;
    settings.width = kWidth, settings.height = kHeight, settings.samplesPerPixel = kSamples;
    ToneMapping mapping;
    mapping.ev = ev_;
    saveImage(folder_ / fmt::format("{}-{}.png", name_, count_), render(engine_.solution(), view_, settings), mapping);
    fmt::print("{},{},{},{:.3f},{:.2f},{},{}\n", name_, count_++, step, seconds, solve_, report.particlesRetraced,
               engine_.solution().report().counts.particles);
    std::fflush(stdout);
  }

  std::string name_;
  View view_;
  double ev_;
  std::filesystem::path folder_;
  Engine engine_;
  std::vector<TransformObject> moves_;
  double solve_ = 0;
  int count_ = 0;
};

void positions(Figure figure) {
  for (std::size_t i = 0; i < figure.moves().size(); ++i) {
    figure.move(figure.moves()[i]);
    figure.update(fmt::format("move {}", i + 1));
  }
}

void drag(Figure figure) {
  const std::size_t last = figure.moves().size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    TransformObject part = figure.moves()[i];
    for (int axis = 0; axis < 3; ++axis) part.matrix[3][axis] /= kFrames;
    for (int k = 1; k <= kFrames; ++k) {
      figure.move(part);
      figure.frame(fmt::format("frame {} of move {}", k, i + 1), i < 2 && k == kFrames / 2);
    }
  }
  figure.update("rest");
}

int run(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"columns"}) {
    fmt::print("{}\n", kColumns);
    return 0;
  }
  if (words.size() != 7 || (words[0] != "positions" && words[0] != "drag"))
    throw std::runtime_error(
        "usage: paper_figures_bench columns | positions|drag NAME SCENE VIEW EDITS.json EV FOLDER");
  const std::span<const std::string> rest = std::span(words).subspan(1);
  SolveSettings settings;
  if (words[0] == "positions") {
    positions(Figure(rest, settings));
  } else {
    settings.method = SolveMethod::Paper;
    drag(Figure(rest, settings));
  }
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  return deltalux::bench::runMain("paper_figures_bench", argc, argv, deltalux::bench::run);
}
