#pragma once
// Words of a line of OBJ or MTL.
#include <algorithm>
#include <string>
#include <string_view>

namespace deltalux::io {

inline constexpr std::string_view kBlank = " \t";

/// Takes the first word off `line`; empty at its end.
inline std::string_view takeWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace deltalux::io
