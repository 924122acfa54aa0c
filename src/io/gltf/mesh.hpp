#pragma once
// Mesh primitives of glTF as meshes. [glTF 2.0, 3.7.2]
#include <deltalux/shape.hpp>
#include <map>
#include <optional>
#include <string>

#include "io/gltf/document.hpp"
#include "io/gltf/material.hpp"

namespace deltalux::io {

/// The triangles of a primitive in the coordinates of its mesh, with texture coordinates when `texture` uses them.
/// nullopt for points and lines. Counts what is left out in `ignored`. Throws InputError.
std::optional<Mesh> readMesh(const GltfDocument&, const tinygltf::Primitive&, const std::string& where,
                             const std::optional<TextureUse>& texture, std::map<std::string, std::size_t>& ignored);

/// `mesh` in world coordinates, without triangles that have no area; front sides stay in front when `toWorld` mirrors.
/// [glTF 2.0, 3.7.4] Throws InputError in the name of `file` when coordinates become too large.
Mesh placedMesh(const Mesh& mesh, const Mat4& toWorld, const std::string& file, const std::string& where,
                std::map<std::string, std::size_t>& ignored);

}  // namespace deltalux::io
