#pragma once
// Options that every command takes where they make sense, and what follows from them.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <deltalux/report.hpp>
#include <memory>
#include <string>

#include "progress_printer.hpp"

namespace deltalux::cli {

struct RunOptions {
  std::size_t threads = 0;  // 0: as many as the machine has
  std::uint64_t seed = 1;
  std::string report;  // file name, empty for none
  std::string progress;
  bool quiet = false;

  void addReport(CLI::App&);    // --report, --quiet
  void addLongWork(CLI::App&);  // --threads, --seed, --progress

  ProgressStyle progressStyle() const;
};

/// One run of a command: its clock, its threads, its report, what it says to people.
class Run {
 public:
  /// Throws OutputError when the report has no place to go.
  Run(std::string command, const RunOptions&);

  RunReport report;

  /// A line on stderr for people; nothing with --quiet.
  void say(const std::string&) const;
  /// Seconds since the run began.
  double elapsed() const;
  /// Completes the report and writes it where --report says.
  void finish();

 private:
  RunOptions options_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<tbb::global_control> threadLimit_;
};

}  // namespace deltalux::cli
