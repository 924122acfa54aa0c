#pragma once
// Scenes of pbrt-v4. [pbrt]
//
// Shapes: trianglemesh, plymesh, bilinearmesh, whole spheres, cylinders and disks, and instances of objects. Materials:
// diffuse, coateddiffuse, conductor, coatedconductor, dielectric, thindielectric, diffusetransmission, interface, mix.
// Lights: point, spot, distant, infinite without an image, diffuse area lights. Cameras: perspective. Textures count
// with their mean, alpha as coverage. All else that light depends on is counted; what only steers pbrt's rendering is
// passed over.
//
// Numbers are those of the file: `rgb 1 1 1` of a light is 1 W/(sr m2) or 1 W/sr in each channel, `scale` times, where
// pbrt means an illuminant of luminance 1. A spectrum or a black body tells the colour of a light alone, at luminance
// 1, as pbrt has it; `power` and `illuminance` are W and W/m2 at rgb 1, `power` that of a shape as a whole, not of each
// of its triangles. Coordinates are the file's, too. pbrt's cameras have a left-handed frame: where a scene does not
// mirror it (`Scale -1 1 1`), pbrt's pictures are the mirror image of ours, which a warning says. What is up, the
// camera says.
//
// A surface's front, from which its area light shines, is where the order of its corners or its normals say, or turned
// over by ReverseOrientation; a transform that mirrors keeps it in front, as pbrt has it.
#include <deltalux/io.hpp>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Throws InputError: file, line, what to do.
ImportedScene loadPbrt(const std::filesystem::path& file, const ImportSettings&);

/// The same from the text of a file called `name` in messages, which names other files of `folder`.
ImportedScene readPbrt(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                       const ImportSettings&);

}  // namespace deltalux::io
