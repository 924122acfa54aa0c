#pragma once
// What the bytes of a case in corpus/obj mean: OBJ text; what follows a line "#mtl" is the file fuzz.mtl beside it.
#include <filesystem>
#include <fstream>
#include <string_view>

namespace deltalux::fuzz {

/// The OBJ text of `input`; its materials are written to fuzz.mtl in `folder`.
inline std::string_view objOf(std::string_view input, const std::filesystem::path& folder) {
  constexpr std::string_view kMark = "\n#mtl\n";
  const std::size_t mark = input.find(kMark);
  if (mark == std::string_view::npos) return input;
  std::ofstream(folder / "fuzz.mtl", std::ios::binary) << input.substr(mark + kMark.size());
  return input.substr(0, mark);
}

}  // namespace deltalux::fuzz
