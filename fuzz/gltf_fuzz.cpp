// Any bytes as glTF, JSON or binary: a scene that passes validation, or an InputError.
#include <cstdint>
#include <deltalux/error.hpp>

#include "io/gltf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    validate(deltalux::io::readGltf(bytes, "fuzz.gltf", "/nonexistent", {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
