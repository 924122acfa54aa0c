#pragma once
// Caustic textures on the graphics card: one texture and its triangles each, written again when their side says that
// they have changed.
#include <deltalux/solution_mesh.hpp>

#include "gl/objects.hpp"
#include "gl/visibility.hpp"

namespace deltalux::viewer::gl {

class CausticStore {
 public:
  struct Shown {
    Extent extent;
    std::uint32_t side = 0, indices = 0;
    Texture2D texels;  // E, and 1 where it shows; nothing beyond its border
    Buffer vertices, triangles;
    VertexArray array;   // attributes as in a mesh store, without irradiance; 4: coordinates in the material's texture
    TextureId material;  // the side's texture
  };

  /// Returns the bytes that were uploaded. Snapshots must be of one SolutionReader.
  std::uint64_t update(const std::shared_ptr<const SolutionMesh>&);
  /// visit(Shown&), side by side.
  template <class Visit>
  void forEach(const Visit& visit) {
    for (std::vector<Shown>& textures : sides_)
      for (Shown& shown : textures)
        if (shown.indices > 0) visit(shown);
  }

 private:
  std::vector<std::vector<Shown>> sides_;
  std::shared_ptr<const SolutionMesh> mesh_;
};

}  // namespace deltalux::viewer::gl
