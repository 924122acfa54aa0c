#pragma once
// Progress of long work: a bar on a terminal, JSON lines on request, and the way a Ctrl-C reaches the library.
#include <chrono>
#include <deltalux/progress.hpp>
#include <string>

namespace deltalux::cli {

enum class ProgressStyle {
  None,
  Bar,  // on stderr, one line, redrawn at most ten times a second
  Json  // on stdout, lines {"phase", "fraction", "elapsed_s"}: at most ten a second, and the first and last of a phase
};

class ProgressPrinter : public Progress {
 public:
  explicit ProgressPrinter(ProgressStyle);
  /// Takes the bar off the screen.
  ~ProgressPrinter() override;

  void report(std::string_view phase, double fraction) override;
  bool stopRequested() const override;

 private:
  using Clock = std::chrono::steady_clock;

  bool due(std::string_view phase, double fraction);
  void drawBar(double fraction);
  void printLine(double fraction) const;
  double elapsedInPhase() const;

  ProgressStyle style_;
  Clock::time_point start_ = Clock::now(), phaseStart_ = start_, lastPrint_ = start_;
  std::string phase_;
  double lastFraction_ = -1;
  bool drawn_ = false;
};

}  // namespace deltalux::cli
