#pragma once
// Rectangles put onto square pages, the highest first, each where its upper edge comes lowest on the skyline of those
// before. [Jylanki10, SKYLINE-BL]
// Cost: a walk along the skyline a rectangle.
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace deltalux::exporting {

struct PackedRect {
  std::uint32_t page = 0;
  glm::ivec2 corner{0};  // the least coordinates [texels]
};

struct Packing {
  std::vector<PackedRect> at;     // by rectangle
  std::vector<glm::ivec2> pages;  // what of each is used [texels]
};

/// No two rectangles overlap. Precondition: every size is 1 to `side`.
Packing packRects(std::span<const glm::ivec2> sizes, int side);

}  // namespace deltalux::exporting
