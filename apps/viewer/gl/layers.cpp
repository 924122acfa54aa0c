#include "gl/layers.hpp"

#include <algorithm>

namespace deltalux::viewer::gl {

namespace {
constexpr float kRaysForAll = 4;  // of a pixel, from which on the picture alone is shown

float weightOf(std::uint32_t rays) {
  return rays == 0 ? 0.0f : std::min(1.0f, 0.5f + 0.5f * (static_cast<float>(rays) - 1) / (kRaysForAll - 1));
}
}  // namespace

std::uint64_t Layers::setCache(const CacheFrame& frame) {
  std::uint64_t uploaded = 0;
  const auto known = [](const glm::vec4& p) { return p.w > 0; };
  hasCache_ = std::any_of(frame.pixels.begin(), frame.pixels.end(), known);
  if (!hasCache_) return uploaded;
  cache_.assign(kRgba32F, frame.width, frame.height, frame.pixels.data(), uploaded);
  return uploaded;
}

std::uint64_t Layers::setPicture(std::shared_ptr<const Picture> picture) {
  hasPicture_ = true;
  std::uint64_t uploaded = 0;
  if (picture == pictureUploaded_) return uploaded;
  const Image& image = picture->image;
  std::vector<glm::vec4> texels;
  texels.reserve(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    texels.emplace_back(image.pixels[i], picture->done ? 1.0f : weightOf(picture->rays[i]));
  picture_.assign(kRgba32F, image.width, image.height, texels.data(), uploaded);
  pictureUploaded_ = std::move(picture);
  return uploaded;
}

}  // namespace deltalux::viewer::gl
