#pragma once
// Colours of vertices, which multiply the base colour (COLOR_0). [glTF 2.0, 3.7.2.1]
//
// A mesh of one colour, or of few that change only between triangles, is parted by colour, so that flat faces stay
// flat. Any other becomes textured: each triangle has two by two texels of its own, between whose centres colours run
// as they do between its corners. Where the material has a texture already, the mean colour counts.
#include <deltalux/scene.hpp>
#include <optional>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// Linear RGB by vertex, none below 0; empty where a primitive has no COLOR_0. Throws InputError.
std::vector<Rgb> readVertexColours(const GltfDocument&, const tinygltf::Primitive&, std::size_t vertexCount,
                                   const std::string& where);

struct ColouredMesh {
  Mesh mesh;
  Rgb mean{1.0f};                  // factor of the base colour; of the texture, its mean
  std::optional<Texture> texture;  // that has the factor instead, by the mesh's texture coordinates
};

/// `byMean`: one colour is all that the material can take.
std::vector<ColouredMesh> colouredMeshes(Mesh, const std::vector<Rgb>& colours, bool byMean);

}  // namespace deltalux::io
