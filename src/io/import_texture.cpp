#include "io/import_texture.hpp"

#include <stb/stb_image.h>

#include <array>
#include <deltalux/image.hpp>
#include <memory>

namespace deltalux::io {

namespace {

std::array<float, 256> tableOf(TexelEncoding encoding) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i)
    table[i] =
        encoding == TexelEncoding::Srgb ? static_cast<float>(decodeSrgb(i / 255.0)) : static_cast<float>(i) / 255.0f;
  return table;
}

// No format packs more texels into a byte; a header that says so is a trap for memory.
bool plausibleSize(double width, double height, std::size_t bytes) {
  constexpr double kMaxTexels = 64e6, kTexelsPerByte = 1e4;  // [limit]
  return width > 0 && height > 0 && width * height <= kMaxTexels &&
         width * height <= kTexelsPerByte * static_cast<double>(bytes);
}

struct Pixels {
  int width = 0, height = 0;
  std::unique_ptr<stbi_uc, void (*)(void*)> bytes{nullptr, stbi_image_free};  // so many of each as were asked for

  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

std::optional<Pixels> decode(std::string_view bytes, int channels) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // [limit]
  if (bytes.empty() || bytes.size() > kMaxBytes) return std::nullopt;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  Pixels pixels;
  int stored = 0;
  if (!stbi_info_from_memory(data, size, &pixels.width, &pixels.height, &stored)) return std::nullopt;
  if (!plausibleSize(pixels.width, pixels.height, bytes.size())) return std::nullopt;
  pixels.bytes.reset(stbi_load_from_memory(data, size, &pixels.width, &pixels.height, &stored, channels));
  if (!pixels.bytes || !plausibleSize(pixels.width, pixels.height, bytes.size())) return std::nullopt;
  return pixels;
}

}  // namespace

std::optional<Texture> decodeTexture(std::string_view bytes, std::string name, TexelEncoding encoding) {
  const std::optional<Pixels> pixels = decode(bytes, 3);
  if (!pixels) return std::nullopt;
  Texture texture;
  texture.name = std::move(name);
  texture.width = pixels->width, texture.height = pixels->height;
  const std::array<float, 256> table = tableOf(encoding);
  texture.texels.resize(pixels->count());
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const stbi_uc* pixel = pixels->bytes.get() + 3 * i;
    texture.texels[i] = Rgb(table[pixel[0]], table[pixel[1]], table[pixel[2]]);
  }
  return texture;
}

std::optional<std::array<double, 256>> alphaShares(std::string_view bytes) {
  const std::optional<Pixels> pixels = decode(bytes, 4);
  if (!pixels) return std::nullopt;
  std::array<double, 256> shares{};
  for (std::size_t i = 0; i < pixels->count(); ++i) shares[pixels->bytes.get()[4 * i + 3]] += 1;
  for (double& share : shares) share /= static_cast<double>(pixels->count());
  return shares;
}

Rgb average(const Texture& texture) {
  RgbSum sum(0);
  for (const Rgb& texel : texture.texels) sum += RgbSum(texel);
  return Rgb(sum / static_cast<double>(texture.texels.size()));
}

}  // namespace deltalux::io
