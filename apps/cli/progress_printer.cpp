#include "progress_printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "interrupt.hpp"

namespace deltalux::cli {

namespace {
constexpr std::chrono::milliseconds kPause{100};

double secondsBetween(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

std::string clockText(double seconds) {
  const auto total = static_cast<long>(seconds + 0.5);
  if (total >= 3600) return fmt::format("{}:{:02}:{:02}", total / 3600, total / 60 % 60, total % 60);
  return fmt::format("{}:{:02}", total / 60, total % 60);
}
}  // namespace

ProgressPrinter::ProgressPrinter(ProgressStyle style) : style_(style) {}

ProgressPrinter::~ProgressPrinter() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

bool ProgressPrinter::stopRequested() const { return interruptRequested(); }

double ProgressPrinter::elapsedInPhase() const { return secondsBetween(phaseStart_, Clock::now()); }

bool ProgressPrinter::due(std::string_view phase, double fraction) {
  const Clock::time_point now = Clock::now();
  const bool newPhase = phase != phase_;
  if (newPhase) {
    phase_ = phase;
    phaseStart_ = now;
    lastFraction_ = -1;
  }
  if (fraction < lastFraction_) return false;  // an estimate that was too hopeful: wait for the truth to catch up
  const bool finished = fraction >= 1.0 && lastFraction_ < 1.0;
  if (!newPhase && !finished && now - lastPrint_ < kPause) return false;
  if (fraction >= 1.0 && lastFraction_ >= 1.0) return false;
  lastPrint_ = now;
  lastFraction_ = fraction;
  return true;
}

void ProgressPrinter::report(std::string_view phase, double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (style_ == ProgressStyle::None || !due(phase, fraction)) return;
  if (style_ == ProgressStyle::Bar)
    drawBar(fraction);
  else
    printLine(fraction);
}

void ProgressPrinter::drawBar(double fraction) {
  constexpr int kCells = 30;
  const int full = static_cast<int>(fraction * kCells);
  const double elapsed = elapsedInPhase();
  std::string left;
  if (fraction > 0.01 && elapsed > 1.0) left = clockText(elapsed * (1.0 - fraction) / fraction) + " left";
  const std::string line = fmt::format("\r\x1b[K{:<10.20} [{:=<{}}{:{}}] {:3.0f} % {}", phase_, "", full, "",
                                       kCells - full, 100.0 * fraction, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressPrinter::printLine(double fraction) const {
  const double elapsed = secondsBetween(start_, Clock::now());
  const nlohmann::ordered_json line{{"phase", phase_}, {"fraction", fraction}, {"elapsed_s", elapsed}};
  std::puts(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

}  // namespace deltalux::cli
