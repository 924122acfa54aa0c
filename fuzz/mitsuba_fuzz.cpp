// Any bytes as a scene of Mitsuba's: one that passes validation, or an InputError.
#include <cstdint>
#include <deltalux/error.hpp>

#include "io/mitsuba.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    validate(
        deltalux::io::readMitsuba({reinterpret_cast<const char*>(data), size}, "fuzz.xml", "/nonexistent", {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
