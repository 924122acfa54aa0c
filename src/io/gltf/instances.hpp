#pragma once
// Where a node's mesh stands, many times over. [EXT_mesh_gpu_instancing]
#include <deltalux/math.hpp>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// From the coordinates of the mesh to those of its node, one per instance; empty where the node has no such extension.
/// Throws InputError.
std::vector<Mat4> instancesOf(const GltfDocument&, int node);

}  // namespace deltalux::io
