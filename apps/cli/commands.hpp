#pragma once
// The commands, one file each: NAME_command.cpp defines add...Command, which puts a subcommand with its options and its
// callback on the app. Callbacks run while the command line is parsed; what they throw decides the exit code
// (main.cpp).
#include <CLI/CLI.hpp>

namespace deltalux::cli {

void addInfoCommand(CLI::App&);
void addSolveCommand(CLI::App&);
void addUpdateCommand(CLI::App&);
void addReplayCommand(CLI::App&);
void addProbeCommand(CLI::App&);
void addRenderCommand(CLI::App&);
void addExportCommand(CLI::App&);
void addReferenceCommand(CLI::App&);
void addDesignCommand(CLI::App&);
void addGridCommand(CLI::App&);
void addGlareCommand(CLI::App&);
void addSheetCommand(CLI::App&);
#ifdef DELTALUX_VIEWER
void addViewCommand(CLI::App&);
#endif

/// All of them, in the order of --help.
inline void addCommands(CLI::App& app) {
  addInfoCommand(app);
  addSolveCommand(app);
  addUpdateCommand(app);
  addReplayCommand(app);
  addProbeCommand(app);
  addRenderCommand(app);
  addExportCommand(app);
  addReferenceCommand(app);
  addDesignCommand(app);
  addGridCommand(app);
  addGlareCommand(app);
  addSheetCommand(app);
#ifdef DELTALUX_VIEWER
  addViewCommand(app);
#endif
}

}  // namespace deltalux::cli
