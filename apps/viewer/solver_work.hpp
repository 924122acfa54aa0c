#pragma once
// What the solver's thread does, one piece of work after another, the most urgent first (solver.hpp).
#include <chrono>
#include <deltalux/progressive_render.hpp>
#include <deltalux/solution_reader.hpp>

#include "solver_mail.hpp"

namespace deltalux::viewer {

using SteadyClock = std::chrono::steady_clock;
inline double secondsSince(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

class SolverWork {
 public:
  SolverWork(SolverInbox& in, SolverOutbox& out, Solver::Settings settings)
      : in_(in), out_(out), settings_(std::move(settings)) {}

  /// Runs until the inbox is stopped. What goes wrong is told as Phase::Failed.
  void run(const Solver::Open& open);

 private:
  void openAndSolve(const Solver::Open&);
  void serve();
  void receive(double patience);

  bool lightIsOld() const { return !edits_.empty() || unsettled_; }
  bool movesOn() const;
  /// How long there is nothing to do, if there are no orders [s].
  double patience() const;
  bool rests() const;
  void prepareSelected();
  void takeEdits();
  void frame();
  void settle();
  void trace();
  void answer();
  void readMeters(bool exact);
  void measure();
  void save();
  bool pictureWaits() const;
  void improvePicture();
  /// Reads what the engine has come to, as well as a display shows or to the bit, and publishes it with `status`.
  enum class Reading { Shown, Exact };
  void publish(Reading);
  void fail(const std::string& message);

  SolverInbox& in_;
  SolverOutbox& out_;
  Solver::Settings settings_;
  std::unique_ptr<Engine> engine_;
  std::optional<SolutionReader> reader_;
  Status status_;

  std::optional<std::string> select_;
  std::vector<Edit> edits_;
  std::uint64_t editCount_ = 0;        // with those that wait here
  bool moving_ = false;                // more edits will follow
  bool unsettled_ = false;             // edits were applied and the light has not settled since
  bool deferred_ = false;              // the last frame left something to the next
  SteadyClock::time_point published_;  // what is shown
  double emitted_ = 0;                 // by all lamps, when it was settled last [W]
  std::vector<PixelRay> rays_;
  std::vector<ProbePoint> meters_;
  std::uint64_t pinned_ = 0;
  bool metersAreExact_ = true;
  std::optional<Orders::Question> question_;
  std::vector<Orders::Save> saves_;
  std::vector<Orders::Measurement> measurements_;
  std::optional<Look> look_;
  std::optional<ProgressiveRender> picture_;
  bool pictureDone_ = false;
  SteadyClock::time_point pictureShown_;
};

}  // namespace deltalux::viewer
