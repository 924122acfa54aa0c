#pragma once
#include <string>
#include <string_view>

namespace deltalux::io {

/// The text with ASCII's capitals as small letters, whatever the locale.
inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace deltalux::io
