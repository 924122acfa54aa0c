// Any change of a sealed solution, and any bytes at all: read into a solution that can be written, or an InputError.
#include <cstdint>
#include <deltalux/error.hpp>

#include "dlx_input.hpp"

namespace {
void read(std::string_view bytes) {
  try {
    const deltalux::SolutionView solution = deltalux::io::readSolution(bytes, "fuzz.dlx");
    deltalux::io::writeSolution(solution, [](std::string_view) {});
  } catch (const deltalux::InputError&) {
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  read(input);
  read(deltalux::fuzz::dlxOf(input));
  read(deltalux::fuzz::dlxOf(input, deltalux::SolveMethod::Paper));
  return 0;
}
