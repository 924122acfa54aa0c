#pragma once
// Mitsuba's bsdfs as materials.
#include <deltalux/io.hpp>
#include <filesystem>
#include <functional>

#include "io/mitsuba/properties.hpp"

namespace deltalux::io::mitsuba {

/// What one file of a scene is read with.
struct Context {
  const std::string& file;
  const std::filesystem::path& folder;
  ImportReport& report;
  std::function<const XmlElement*(const XmlElement& reference)> target;  // of a <ref>; null: unknown
};

/// The colour of a property, or the mean of its texture; `otherwise` where it is not there.
Rgb colourOf(const Context&, const Properties&, std::string_view name, const Rgb& otherwise);

/// Throws InputError.
Material materialOf(const Context&, const XmlElement& bsdf, int depth = 0);

}  // namespace deltalux::io::mitsuba
