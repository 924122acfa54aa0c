#pragma once
// Solutions in files (.dlx): all that probe, render and later updates need, exactly as it was. Other programs of the
// same processor family read them back bit by bit; a file of another format version is refused, not guessed at.
#include <deltalux/solution.hpp>
#include <filesystem>

namespace deltalux {

/// Whether the file's name says that it is a solution: .dlx in either case.
bool isSolutionFile(const std::filesystem::path&);

/// Writes the solution, atomically. Throws OutputError; what stood there before then still stands.
void saveSolution(const std::filesystem::path&, const SolutionView&);

/// Reads a solution. Throws InputError when the file is not a solution, is damaged, or of another format version.
SolutionView loadSolution(const std::filesystem::path&);

}  // namespace deltalux
