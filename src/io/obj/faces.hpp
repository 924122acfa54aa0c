#pragma once
// Faces of an OBJ file, which may have any number of corners, as triangles of a mesh.
#include <deltalux/shape.hpp>
#include <map>
#include <string>
#include <vector>

namespace deltalux::io {

struct ObjVertices {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> texcoords;
};

/// Indices into ObjVertices; -1 where a corner has no texture vertex or normal.
struct ObjCorner {
  int position = 0, texcoord = -1, normal = -1;
  friend auto operator<=>(const ObjCorner&, const ObjCorner&) = default;
};

/// One mesh of `faces`; with texture coordinates (v turned round: OBJ counts from the bottom) when `textured`, with
/// normals when every corner has one. Faces without area are left out and counted in `ignored`.
Mesh meshOf(const ObjVertices&, const std::vector<std::vector<ObjCorner>>& faces, bool textured,
            std::map<std::string, std::size_t>& ignored);

}  // namespace deltalux::io
