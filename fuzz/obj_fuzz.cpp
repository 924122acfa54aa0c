// Any bytes as OBJ: a scene that passes validation, or an InputError. What follows a line "#mtl" is the material file
// that `mtllib fuzz.mtl` finds.
#include <unistd.h>

#include <cstdint>
#include <deltalux/error.hpp>
#include <filesystem>
#include <fstream>

#include "io/obj.hpp"

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
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kMark = "\n#mtl\n";
  const std::size_t mark = bytes.find(kMark);
  if (mark != std::string_view::npos) {
    std::ofstream(folder() / "fuzz.mtl", std::ios::binary) << bytes.substr(mark + kMark.size());
  }
  try {
    validate(deltalux::readObj(bytes.substr(0, mark), "fuzz.obj", folder(), {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
