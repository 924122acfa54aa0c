// Any bytes as OBJ with MTL: a scene that passes validation, or an InputError.
#include <unistd.h>

#include <cstdint>
#include <deltalux/error.hpp>
#include <string>

#include "io/obj.hpp"
#include "obj_input.hpp"

namespace {

// A folder of this process, where the material file goes.
const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    const auto made = std::filesystem::temp_directory_path() / ("deltalux-obj-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(made);
    return made;
  }();
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = deltalux::fuzz::objOf({reinterpret_cast<const char*>(data), size}, folder());
  try {
    validate(deltalux::io::readObj(text, "fuzz.obj", folder(), {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
