#include "support/run_cli.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux::test {

namespace {
/// `command`: the program first.
pid_t start(const std::vector<std::string>& command, const std::filesystem::path& out,
            const std::filesystem::path& err) {
  std::vector<char*> argv;
  for (const std::string& argument : command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("fork failed");
  if (pid > 0) return pid;
  const int outFile = ::open(out.c_str(), O_WRONLY | O_CREAT, 0600),
            errFile = ::open(err.c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(outFile, STDOUT_FILENO);
  ::dup2(errFile, STDERR_FILENO);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

bool ended(pid_t pid) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid;
}

void waitForOutput(pid_t pid, const std::filesystem::path& out) {
  std::error_code error;
  while (!ended(pid) && !(std::filesystem::file_size(out, error) > 0 && !error))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}
}  // namespace

namespace {
CliResult runCommand(const std::vector<std::string>& command, const std::function<void(int)>& whileRunning) {
  const TempFolder folder;
  const pid_t pid = start(command, folder / "out", folder / "err");
  if (whileRunning) {
    waitForOutput(pid, folder / "out");
    whileRunning(pid);
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readText(folder / "out"),
          readText(folder / "err")};
}

std::vector<std::string> joined(std::vector<std::string> command, const std::vector<std::string>& arguments) {
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}
}  // namespace

CliResult runCli(const std::vector<std::string>& arguments, const std::function<void(int)>& whileRunning) {
  return runCommand(joined({DELTALUX_CLI}, arguments), whileRunning);
}

CliResult runCliWithDisplay(const std::vector<std::string>& arguments) {
  return runCommand(joined({(sourceFolder() / "tools" / "with_display").string(), DELTALUX_CLI}, arguments), {});
}

bool hasDisplayServer() { return std::system("command -v Xvfb >/dev/null 2>&1") == 0; }

void expectUsageError(const std::vector<std::string>& arguments) {
  std::string line = "deltalux";
  for (const std::string& argument : arguments) line += " " + argument;
  const CliResult result = runCli(arguments);
  EXPECT_EQ(result.exitCode, 2) << line << "\n" << result.err;
  EXPECT_EQ(result.out, "") << line;
  EXPECT_EQ(result.err.substr(0, 10), "deltalux: ") << line << "\n" << result.err;
  EXPECT_NE(result.err.find("--help)\n"), std::string::npos) << line << "\n" << result.err;
}

std::string bundledScene(const std::string& name) { return (sourceFolder() / "scenes" / name).string(); }

}  // namespace deltalux::test
