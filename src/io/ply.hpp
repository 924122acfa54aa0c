#pragma once
// Meshes of PLY, the Stanford polygon format: as text or binary of either byte order, packed by gzip or not. [PLY]
//
// Read are x, y, z, normals nx, ny, nz and texture coordinates (u, v or s, t) of the element `vertex`, and the list
// vertex_indices (or vertex_index) of the element `face`; faces of more than three corners are triangulated. Normals
// and texture coordinates count where all of them are usable. All else is passed over.
#include <deltalux/shape.hpp>
#include <map>
#include <string>
#include <string_view>

namespace deltalux::io {

/// The mesh, its tables not filled in; without triangles when no face has area. Faces that are left out and elements
/// that are not read are counted in `ignored`. Throws InputError in the name of `file`, with the line where it is text.
Mesh readPly(std::string_view bytes, const std::string& file, std::map<std::string, std::size_t>& ignored);

}  // namespace deltalux::io
