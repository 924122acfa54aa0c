// Any bytes decode to a picture or throw InputError.
#include <cstddef>
#include <deltalux/error.hpp>

#include "io/image/formats.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    deltalux::io::decodeHdr({reinterpret_cast<const char*>(data), size}, "fuzz.hdr");
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
