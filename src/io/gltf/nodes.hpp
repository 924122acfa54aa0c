#pragma once
// The tree of nodes of the scene to be read, flattened: names, parents, transforms to world coordinates.
// [glTF 2.0, 3.5]
#include <deltalux/math.hpp>
#include <string>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

struct PlacedNode {
  int node = -1;     // index in the document
  int parent = -1;   // index in the list, before this one; -1 at the top
  std::string path;  // unique, names joined by '/'
  Mat4 toWorld{1.0};
};

/// The nodes of the default scene, parents before children. Throws InputError when nodes are not a tree (a node under
/// two parents, a cycle) or more than 200 deep.
std::vector<PlacedNode> placedNodes(const GltfDocument&);

}  // namespace deltalux::io
