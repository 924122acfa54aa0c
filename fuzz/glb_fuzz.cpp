// Any document with any binary chunk in a well-formed container: gets past the lengths that stop most random files.
#include <cstdint>
#include <deltalux/error.hpp>

#include "glb_input.hpp"
#include "io/gltf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = deltalux::fuzz::glbOf({reinterpret_cast<const char*>(data), size});
  try {
    validate(deltalux::io::readGltf(file, "fuzz.glb", "/nonexistent", {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
