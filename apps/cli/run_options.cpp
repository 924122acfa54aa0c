#include "run_options.hpp"

#include <tbb/info.h>
#include <unistd.h>

#include <cstdio>
#include <deltalux/output.hpp>

namespace deltalux::cli {

namespace {
std::string notNegative(const std::string& text) { return text.starts_with('-') ? text + " is negative" : ""; }
}  // namespace

void RunOptions::addReport(CLI::App& app) {
  app.add_option("--report", report, "Write a JSON report of the run")->type_name("FILE.json");
  app.add_flag("--quiet", quiet, "Print nothing but errors");
}

void RunOptions::addLongWork(CLI::App& app) {
  app.add_option("--threads", threads, "Threads to use (default: all)")->type_name("N")->check(CLI::Range(1, 4096));
  app.add_option("--seed", seed, "Seed of the random numbers: same seed, same result")
      ->type_name("N")
      ->check(notNegative)  // CLI11 would wrap it round
      ->capture_default_str();
  app.add_option("--progress", progress, "json: progress as JSON lines on standard output")
      ->type_name("json")
      ->check(CLI::IsMember({"json"}));
}

ProgressStyle RunOptions::progressStyle() const {
  if (progress == "json") return ProgressStyle::Json;
  return !quiet && ::isatty(STDERR_FILENO) == 1 ? ProgressStyle::Bar : ProgressStyle::None;
}

Run::Run(std::string command, const RunOptions& options) : options_(options) {
  report.command = std::move(command);
  report.version = DELTALUX_VERSION;
  report.seed = options_.seed;
  report.threads = options_.threads > 0 ? options_.threads : static_cast<std::size_t>(tbb::info::default_concurrency());
  if (options_.threads > 0)
    threadLimit_ =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, options_.threads);
  if (!options_.report.empty()) checkWritable(options_.report);
}

void Run::say(const std::string& text) const {
  if (!options_.quiet) std::fprintf(stderr, "deltalux: %s\n", text.c_str());
}

double Run::elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

void Run::finish() {
  report.times.total = elapsed();
  report.memory.peakRss = peakResidentBytes();
  if (!options_.report.empty()) writeReport(options_.report, report);
}

}  // namespace deltalux::cli
