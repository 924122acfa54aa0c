#pragma once
#include <string_view>

namespace deltalux::scene {

/// Calls `visit` with every prefix of `name` that ends before a separator, shortest first, and then with `name` itself.
/// Empty parts make no prefix of their own: "a..b" has "a" and "a..b".
template <class Visit>
void forEachPrefix(std::string_view name, char separator, Visit&& visit) {
  for (std::size_t i = 1; i + 1 < name.size(); ++i) {
    if (name[i] == separator && name[i - 1] != separator) visit(name.substr(0, i));
  }
  visit(name);
}

}  // namespace deltalux::scene
