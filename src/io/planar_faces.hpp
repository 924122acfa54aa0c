#pragma once
// Small meshes as polygons. The solver parameterises a polygon by its own plane, a mesh only triangle by triangle; so
// walls, boxes and lamps that come as a few triangles are turned back into the faces that they were made of.
//
// Triangles that share an edge and a plane are joined. A joined face becomes a polygon if its outline is one simple
// loop (no hole, no vertex passed twice). The result stands for exactly the same surface, with the same front. Cost:
// O(n) hash look-ups.
#include <deltalux/shape.hpp>
#include <vector>

namespace deltalux::io {

/// The polygons that `mesh` (its tables need not be filled in) consists of; or the mesh itself when it has more than
/// hierarchy::tuning::kInputs triangles, texture coordinates, normals that are not those of its faces, or a face that
/// is no simple polygon. Empty when nothing of it has area.
std::vector<Shape> planarFaces(Mesh mesh);

}  // namespace deltalux::io
