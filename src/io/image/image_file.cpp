#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deltalux/error.hpp>
#include <deltalux/image_io.hpp>
#include <fstream>
#include <sstream>

#include "base/check.hpp"
#include "io/atomic_file.hpp"
#include "io/image/formats.hpp"

namespace deltalux {

namespace {
ImageFormat requireFormat(const std::filesystem::path& path) {
  const std::optional<ImageFormat> format = imageFormatOf(path);
  if (!format)
    throw OutputError(
        fmt::format("cannot write {}: pictures are .exr, .hdr or .png (change the extension)", path.string()));
  return *format;
}

void checkPixels(int width, int height, std::size_t count) {
  DELTALUX_CHECK(width > 0 && height > 0 && count == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                 "a picture needs width x height pixels");
}

std::string readBytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  if (!stream || !(bytes << stream.rdbuf()))
    throw InputError(path.string(), 0, "cannot read this picture", "check its name");
  return std::move(bytes).str();
}
}  // namespace

std::optional<ImageFormat> imageFormatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return ImageFormat::Exr;
  if (extension == ".hdr" || extension == ".pic") return ImageFormat::Hdr;
  if (extension == ".png") return ImageFormat::Png;
  return std::nullopt;
}

void saveImage(const std::filesystem::path& path, const Image& image, const ToneMapping& mapping) {
  checkPixels(image.width, image.height, image.pixels.size());
  switch (requireFormat(path)) {
    case ImageFormat::Exr:
      return io::writeFile(path, io::encodeExr(image));
    case ImageFormat::Hdr:
      return io::writeFile(path, io::encodeHdr(image));
    case ImageFormat::Png:
      return io::writeFile(path, io::encodePng(toneMap(image, mapping)));
  }
}

void saveImage(const std::filesystem::path& path, const DisplayImage& image) {
  checkPixels(image.width, image.height, image.pixels.size());
  if (requireFormat(path) != ImageFormat::Png)
    throw OutputError(fmt::format("cannot write {}: a picture for the screen is a .png", path.string()));
  io::writeFile(path, io::encodePng(image));
}

Image loadImage(const std::filesystem::path& path) {
  const std::optional<ImageFormat> format = imageFormatOf(path);
  if (format == ImageFormat::Exr) return io::decodeExr(readBytes(path), path.string());
  if (format == ImageFormat::Hdr) return io::decodeHdr(readBytes(path), path.string());
  throw InputError(path.string(), 0, "only .exr and .hdr pictures hold radiance and can be read");
}

std::string viewOptions(const View& view, const Vec3& origin) {
  const auto vector = [](const Vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z); };
  const auto place = [](const Vec3& v) { return fmt::format("{:.12g} {:.12g} {:.12g}", v.x, v.y, v.z); };
  return fmt::format("-vt{} -vp {} -vd {} -vu {} -vh {:.9g} -vv {:.9g}",
                     view.kind == View::Kind::Perspective ? 'v' : 'l',
                     origin == Vec3(0) ? vector(view.position) : place(view.position + origin), vector(view.direction),
                     vector(view.up), view.horizontal, view.vertical);
}

}  // namespace deltalux
