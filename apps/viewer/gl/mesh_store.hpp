#pragma once
// A SolutionMesh on the graphics card. All sides lie in one buffer of vertices, one of irradiance and one of triangles,
// so that many are drawn by one call; what a snapshot has changed is written in place. What does not change with light
// (places, texture coordinates) and what changes with it alone (irradiance; reflectance and emission by side) are
// apart.
//
// A side of which both the object and the version are those of the snapshot before is not looked at: so snapshots must
// be of one SolutionReader; in which order they come is all the same.
#include <deltalux/solution_mesh.hpp>

#include "gl/objects.hpp"
#include "gl/pane_table.hpp"
#include "gl/visibility.hpp"

namespace deltalux::viewer::gl {

/// Texture that multiplies what a primitive reflects; invalid: none.
TextureId textureOf(const Scene&, PrimitiveId);

class MeshStore {
 public:
  struct Side {
    Extent extent;
    std::uint32_t firstIndex = 0, indices = 0;  // in the buffer of triangles
    bool seenThrough = false;
    bool passesOther = false;  // light of its other side shows on it
    TextureId texture;         // of the material, where the shape has coordinates for it

   private:
    friend class MeshStore;
    std::uint32_t firstVertex_ = 0, vertexRoom_ = 0, indexRoom_ = 0;
  };

  /// Takes over what has changed. Returns the bytes that were uploaded for it.
  std::uint64_t update(std::shared_ptr<const SolutionMesh>);
  const SolutionMesh* mesh() const { return mesh_.get(); }
  const std::vector<Side>& sides() const { return sides_; }
  /// Sides with triangles: by material texture, then by their place in the buffer.
  const std::vector<std::uint32_t>& order() const { return order_; }

  GLuint triangles() { return triangles_.name(); }  // a vertex array, 32 bit indices
  GLuint sideTable() { return table_.name(); }      // a buffer texture (shaders.hpp)
  GLuint paneTable() { return panes_.texture(); }

  /// Outlines of the patches as lines: how many indices, and their vertex array. Uploaded while they are asked for.
  std::uint32_t outlines(std::uint64_t& uploaded);
  GLuint lines() { return lines_.name(); }

 private:
  struct Vertex {
    glm::vec3 position;
    std::uint32_t side;
    glm::vec2 uv;
  };
  using SideList = std::vector<std::size_t>;

  void rebuild(std::uint64_t& uploaded);
  bool moveToEnd(Side&, std::size_t vertices, std::size_t indices);
  void writeShape(std::size_t side, std::uint64_t& uploaded);
  void writeLight(std::size_t side, std::uint64_t& uploaded);
  void readMaterials();
  void sortOrder();
  void updateTable(std::uint64_t& uploaded);

  std::shared_ptr<const SolutionMesh> mesh_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> order_;
  std::size_t verticesUsed_ = 0, indicesUsed_ = 0, vertexRoom_ = 0, indexRoom_ = 0;
  Buffer vertices_, irradiance_, indices_, lineIndices_;
  VertexArray triangles_, lines_;
  BufferTexture table_;
  std::vector<glm::vec4> tableRows_;
  PaneTable panes_;
  std::uint32_t outlineIndices_ = 0;
  bool outlinesFit_ = false;
};

}  // namespace deltalux::viewer::gl
