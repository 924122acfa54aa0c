// Any bytes as a TM-33 luminaire: a distribution of finite, non-negative candelas, or an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deltalux/error.hpp>

#include "io/ies.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const deltalux::io::PhotometryFile file = deltalux::io::readPhotometry(text, "fuzz.xml", "/nonexistent");
    const double flux = deltalux::luminousFlux(file.photometry);
    if (!(flux >= 0) || !std::isfinite(flux)) std::abort();
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
