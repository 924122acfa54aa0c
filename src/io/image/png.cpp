#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include <stdexcept>

#include "io/image/formats.hpp"

namespace deltalux::io {

namespace {

std::string encode(int width, int height, int channels, const void* pixels) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (!stbi_write_png_to_func(append, &bytes, width, height, channels, pixels, channels * width))
    throw std::runtime_error("PNG encoding failed: out of memory");
  return bytes;
}

}  // namespace

std::string encodePng(const DisplayImage& image) { return encode(image.width, image.height, 3, image.pixels.data()); }

std::string encodePng(int width, int height, std::span<const std::array<std::uint8_t, 4>> rgba) {
  return encode(width, height, 4, rgba.data());
}

}  // namespace deltalux::io
