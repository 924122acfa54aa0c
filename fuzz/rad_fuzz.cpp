// Any bytes as a Radiance scene with the files that it includes: a valid scene, or an InputError.
#include "rad_input.hpp"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!deltalux::io::radiance::readsCleanly({reinterpret_cast<const char*>(data), size})) std::abort();
  return 0;
}
