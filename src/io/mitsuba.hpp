#pragma once
// Scenes of Mitsuba 3 (and of older ones, whose names in camelCase mean the same), in XML. [Mitsuba]
//
// Shapes: obj, ply, rectangle, cube, sphere, cylinder, disk, shapegroup and instance. Materials: diffuse, plastic and
// conductors, rough or not, dielectric and thindielectric, principled, twosided, mask. Emitters: area, point, spot,
// directional, constant. Sensors: perspective. Textures count with their mean, spectra as gray. All else is counted.
// Radiance and intensity are W/(sr m2) and W/sr, as numbers stand there. What is up, the first sensor says.
#include <deltalux/io.hpp>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Throws InputError: file, line, what to do.
ImportedScene loadMitsuba(const std::filesystem::path& file, const ImportSettings&);

/// The same from the text of a file called `name` in messages, which names other files of `folder`.
ImportedScene readMitsuba(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                          const ImportSettings&);

}  // namespace deltalux::io
