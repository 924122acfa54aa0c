#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// A `!command` line, not run by any shell.
struct RadCommand {
  std::string text;
  SourceLine where;
};

using RadItem = std::variant<RadObject, RadCommand>;

/// The objects and commands of one text, in order. Argument counts fit the types. Throws InputError.
std::vector<RadItem> parseRadiance(std::string_view text, std::shared_ptr<const std::string> file);

}  // namespace deltalux::io::radiance
