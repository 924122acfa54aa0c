// deltalux COMMAND ...: what went wrong, and where, becomes the exit code; every error is one message on stderr.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deltalux/error.hpp>
#include <deltalux/memory.hpp>
#include <deltalux/scene.hpp>
#include <exception>
#include <new>

#include "commands.hpp"
#include "interrupt.hpp"

namespace {

using namespace deltalux;

constexpr int kDone = 0, kInternal = 1, kUsage = 2, kInput = 3, kOutput = 4, kInterrupted = 130;

constexpr const char* kFooter =
    "\nSCENE is one .gltf, .glb, .obj, .xml (Mitsuba) or .pbrt file, or .rad files that are read as one scene, in "
    "order.\n"
    "SOLUTION is a .dlx file that solve wrote; a SCENE in its place is solved first.\n"
    "Exit codes: 0 done; 2 the command line is wrong; 3 the input is wrong; 4 output could not be written (what stood\n"
    "there before still stands); 130 interrupted.";

int complain(int code, const char* what) {
  std::fflush(stdout);
  std::fprintf(stderr, "deltalux: %s\n", what);
  return code;
}

/// The deepest subcommand that was named, for its own --help.
std::string helpCommand(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "deltalux --help" : "deltalux " + chosen.front()->get_name() + " --help";
}

/// CLI11 would only say that a subcommand is missing.
void requireKnownCommand(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (argc < 2)
    throw CLI::ExtrasError(fmt::format("say what to do: {}", fmt::join(names, ", ")), CLI::ExitCodes::RequiredError);
  if (argv[1][0] == '-') return;
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  throw CLI::ExtrasError(
      fmt::format("there is no command '{}'; nearest: {}", argv[1], fmt::join(nearMisses(argv[1], names), ", ")),
      CLI::ExitCodes::ExtrasError);
}

int run(CLI::App& app, int argc, char** argv) {
  try {
    requireKnownCommand(app, argc, argv);
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) throw OutputError("cannot write to standard output");
    return kDone;
  } catch (const CLI::Success& help) {  // --help and --version
    return app.exit(help) == 0 && std::fflush(stdout) == 0 ? kDone : kOutput;
  } catch (const CLI::ParseError& error) {
    return complain(kUsage, (std::string(error.what()) + " (see " + helpCommand(app) + ")").c_str());
  } catch (const InputError& error) {
    return complain(kInput, error.what());
  } catch (const OutputError& error) {
    return complain(kOutput, error.what());
  } catch (const Interrupted&) {
    return complain(kInterrupted, "interrupted; nothing was written");
  } catch (const std::bad_alloc&) {
    return complain(kInternal, "out of memory");
  } catch (const std::exception& error) {
    return complain(kInternal, (std::string("internal error, please report it: ") + error.what()).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  keepFreedMemory();
  cli::catchInterrupts();
  CLI::App app{"Physically based global illumination, updated incrementally.", "deltalux"};
  app.set_version_flag("--version", "deltalux " DELTALUX_VERSION);
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.footer(kFooter);
  app.require_subcommand(1);
  cli::addCommands(app);
  return run(app, argc, argv);
}
