#pragma once
// Wavefront OBJ, parsed by tinyobjloader, with MTL materials (io/obj/mtl.hpp).
//
// Objects are named by `o` and `g` lines ("house/walls"; several group names joined by '_', '/' inside a name as '_').
// Faces of one object and one material make a mesh, or polygons where that is exact (io/planar_faces.hpp); concave
// faces are triangulated in their plane, bent ones as a fan. The format has no unit and no upright: lengths follow
// ImportSettings::metresPerUnit, and +Y is taken as up, as most exporters write it. Materials: io/obj/material.hpp.
// Ignored, counted and said in one warning: points, lines, curves and surfaces of free form, bump and other maps.
#include <deltalux/io.hpp>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Throws InputError: file, line, what to do.
ImportedScene loadObj(const std::filesystem::path& file, const ImportSettings&);

/// The same from the text of a file called `name` in messages, whose materials are looked for in `folder`.
ImportedScene readObj(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                      const ImportSettings&);

}  // namespace deltalux::io
