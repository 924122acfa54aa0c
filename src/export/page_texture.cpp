#include "export/page_texture.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/image.hpp>

namespace deltalux::exporting {

namespace {

constexpr int kMostTexels = 1024;  // of a side of a texture [limit]

Texture halved(const Texture& t) {
  Texture out{t.name, std::max(t.width / 2, 1), std::max(t.height / 2, 1), {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      Rgb sum(0.0f);
      for (const int dy : {0, 1})
        for (const int dx : {0, 1})
          sum +=
              t.texels[std::size_t(std::min(2 * y + dy, t.height - 1)) * t.width + std::min(2 * x + dx, t.width - 1)];
      out.texels.push_back(0.25f * sum);
    }
  return out;
}

}  // namespace

PageTexture pageTexture(const Texture& texture) {
  Texture t = texture;
  while (std::max(t.width, t.height) > kMostTexels) t = halved(t);
  PageTexture out{t.width, t.height, {}};
  for (const Rgb& texel : t.texels) {
    for (int c = 0; c < 3; ++c)
      out.rgba += static_cast<char>(std::lround(255 * encodeSrgb(std::clamp(double(texel[c]), 0.0, 1.0))));
    out.rgba += static_cast<char>(255);
  }
  return out;
}

}  // namespace deltalux::exporting
