#pragma once
#include <deltalux/solution_file.hpp>
#include <string>
#include <string_view>

#include "io/solution_file/container.hpp"

namespace deltalux::io {

/// The bytes of the solution's .dlx file.
void writeSolution(const SolutionView&, const ByteSink&);

/// The solution in the bytes of a .dlx file. Throws InputError in the name of `file`.
SolutionView readSolution(std::string_view bytes, const std::string& file);

}  // namespace deltalux::io
