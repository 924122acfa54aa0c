#pragma once
// What Radiance's function files define that scenes take for granted, in calc's language.
#include <optional>
#include <string_view>

namespace deltalux::io::radiance {

/// Known to every function file: guarded functions, conditions, constants. Noise is left out. [Radiance, rayinit.cal]
std::string_view standardFunctions();

/// The function file of that name, or nullopt: source.cal, which ies2rad's output names. [Radiance, ies2rad(1)]
std::optional<std::string_view> functionFile(std::string_view name);

}  // namespace deltalux::io::radiance
