#pragma once
// The caustic textures of one group of lights on one sheet, each with a border of one texel of its own, so that texels
// between do not mix them.
#include <deltalux/solution_mesh.hpp>
#include <optional>

#include "export/page_mesh.hpp"

namespace deltalux::exporting {

struct PageCaustics {
  int width = 0, height = 0;
  std::vector<std::uint32_t> texels;     // RGB9E5, E [W/m2], row by row
  std::vector<std::uint8_t> shows;       // 255 where the texel shows, else 0
  std::vector<Vec3f> positions;          // by vertex
  std::vector<glm::vec2> texcoords;      // [0,1] over the sheet
  std::vector<std::uint32_t> materials;  // of PageMesh
  std::vector<std::uint32_t> triangles;
};

/// nullopt: the group has none.
std::optional<PageCaustics> pageCaustics(const PageMesh&, const SolutionMesh&);

}  // namespace deltalux::exporting
