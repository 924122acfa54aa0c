#pragma once
// A material's texture as a page has it.
#include <deltalux/scene.hpp>
#include <string>

namespace deltalux::exporting {

/// sRGB-encoded, four bytes a texel (the fourth 255), row by row from the top (v = 0).
struct PageTexture {
  int width = 0, height = 0;
  std::string rgba;
};

/// Halved until neither side is above the limit.
PageTexture pageTexture(const Texture&);

}  // namespace deltalux::exporting
