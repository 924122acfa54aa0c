// Any bytes as a scene of pbrt's: one that passes validation, or an InputError.
#include <cstdint>
#include <deltalux/error.hpp>

#include "io/pbrt.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    validate(
        deltalux::io::readPbrt({reinterpret_cast<const char*>(data), size}, "fuzz.pbrt", "/nonexistent", {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
