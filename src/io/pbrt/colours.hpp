#pragma once
// Colours of pbrt's parameters: numbers as they stand, spectra as io/spectrum.hpp has them, textures by their mean.
#include <deltalux/io.hpp>
#include <filesystem>
#include <map>

#include "io/pbrt/entity.hpp"

namespace deltalux::io::pbrt {

struct NamedTexture {
  Entity definition;
  std::optional<Rgb> mean;  // once it was asked for
};

/// What a scene is read with.
struct Context {
  std::filesystem::path folder;  // where files are that it names
  ImportReport& report;
  std::map<std::string, NamedTexture, std::less<>> textures;  // "spectrum NAME" and "float NAME"
  int textureDepth = 0;                                       // of the one that is looked at now
};

void ignore(Context&, const std::string& what);
/// The file that a parameter names. Throws InputError.
std::filesystem::path fileOf(const Context&, const Parameter&);

/// A colour that multiplies light, at least 0. Throws InputError.
Rgb colourOr(Context&, const Entity&, std::string_view name, const Rgb& otherwise);
/// The same of a number.
double scalarOr(Context&, const Entity&, std::string_view name, double otherwise);
/// The colour of a light, white where it is not there: rgb as it stands, any spectrum of luminance 1. Throws
/// InputError.
Rgb lightColourOf(Context&, const Entity&, std::string_view name);

}  // namespace deltalux::io::pbrt
