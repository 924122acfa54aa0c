#pragma once
// What of a mesh store has to be drawn for a camera, in few calls.
#include "drawing.hpp"
#include "gl/mesh_store.hpp"

namespace deltalux::viewer::gl {

/// Runs of the buffer of triangles, neighbours joined.
struct Runs {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::uint64_t triangles = 0;

  void add(std::uint32_t firstIndex, std::uint32_t indices);
  void draw() const;

 private:
  std::uint32_t end_ = 0;
};

struct DrawList {
  struct Group {
    TextureId texture;   // of the material
    bool ahead = false;  // with the hand's matrix
    Runs runs;
  };
  std::vector<Group> opaque;
  std::vector<Group> panes;   // what is seen through, one side each, the farthest first
  std::vector<Group> behind;  // sides whose light shows on the other side of them: seen from behind
  std::vector<char> ahead;    // by primitive; empty: none
  DepthRange depths;

  bool isAhead(std::size_t side) const { return !ahead.empty() && ahead[side / 2]; }
};

/// `wholePanes`: what is seen through and takes light is drawn as if nothing were seen through it.
DrawList drawListOf(const MeshStore&, const Eye&, const std::optional<Box>& section, const Ahead*, bool wholePanes);

}  // namespace deltalux::viewer::gl
