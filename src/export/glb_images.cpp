#include "export/glb_images.hpp"

#include <algorithm>
#include <cmath>

#include "export/rgbm.hpp"
#include "io/image/formats.hpp"

namespace deltalux::exporting {

namespace {

constexpr int kLinear = 9729, kClampToEdge = 33071, kRepeat = 10497, kLinearMipmapLinear = 9987;  // [defined]

std::size_t addTexture(GlbContainer& glb, const std::string& png, const std::string& name, GlbJson sampler) {
  const std::size_t view = glb.addView(png, 1, 0);
  const std::size_t image = glb.add("images", {{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
  GlbJson& samplers = glb.json["samplers"];
  auto known = std::find(samplers.begin(), samplers.end(), sampler);
  const auto index = static_cast<std::size_t>(known - samplers.begin());
  if (known == samplers.end()) samplers.push_back(std::move(sampler));
  return glb.add("textures", {{"name", name}, {"sampler", index}, {"source", image}});
}

std::uint8_t byteOf(double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

}  // namespace

std::size_t addAtlasTexture(GlbContainer& glb, const std::string& png, const std::string& name) {
  return addTexture(glb, png, name,
                    {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}});
}

std::size_t addSceneTexture(GlbContainer& glb, const Texture& texture) {
  DisplayImage picture;
  picture.width = texture.width, picture.height = texture.height;
  for (const Rgb& texel : texture.texels)
    picture.pixels.push_back({byteOf(encodeSrgb(texel.r)), byteOf(encodeSrgb(texel.g)), byteOf(encodeSrgb(texel.b))});
  return addTexture(
      glb, io::encodePng(picture), texture.name,
      {{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", kRepeat}, {"wrapT", kRepeat}});
}

std::string linearPng(const Image& image, float white) {
  DisplayImage picture;
  picture.width = image.width, picture.height = image.height;
  picture.pixels.reserve(image.pixels.size());
  for (const Rgb& p : image.pixels)
    picture.pixels.push_back({byteOf(p.r / white), byteOf(p.g / white), byteOf(p.b / white)});
  return io::encodePng(picture);
}

std::string rgbmPng(const Image& image, float intensity) {
  std::vector<std::array<std::uint8_t, 4>> texels;
  texels.reserve(image.pixels.size());
  for (const Rgb& p : image.pixels) texels.push_back(packRgbm(p / intensity));
  return io::encodePng(image.width, image.height, texels);
}

}  // namespace deltalux::exporting
