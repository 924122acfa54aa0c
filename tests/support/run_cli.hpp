#pragma once
// Runs the real deltalux binary and collects what it says.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace deltalux::test {

struct CliResult {
  int exitCode = -1;  // 128 + signal when one ended it
  std::string out, err;
};

/// Runs DELTALUX_CLI with `arguments` and waits. `whileRunning`, when given, is called with the process id once
/// standard output is not empty, or when the process has ended.
CliResult runCli(const std::vector<std::string>& arguments, const std::function<void(int pid)>& whileRunning = {});

/// The same with a display that no screen shows (tools/with_display), which needs hasDisplayServer().
CliResult runCliWithDisplay(const std::vector<std::string>& arguments);
bool hasDisplayServer();

/// Expects exit code 2 with one message that points to --help, and nothing on standard output.
void expectUsageError(const std::vector<std::string>& arguments);

/// A scene of this repository, e.g. "cornell/cornell.rad".
std::string bundledScene(const std::string& name);

}  // namespace deltalux::test
