#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace deltalux::bench {

/// main() of a benchmark: run(arguments) gives the exit status; what it throws is one message under `name`, and 1.
template <class Run>
int runMain(const char* name, int argc, char** argv, const Run& run) {
  try {
    return run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 1;
  }
}

}  // namespace deltalux::bench
