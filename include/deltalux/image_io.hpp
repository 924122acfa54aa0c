#pragma once
// Pictures in files. Writing is atomic: the file appears complete or not at all.
#include <deltalux/image.hpp>
#include <deltalux/view.hpp>
#include <filesystem>
#include <optional>
#include <string>

namespace deltalux {

enum class ImageFormat {
  Exr,  // OpenEXR, 32-bit float: lossless
  Hdr,  // Radiance RGBE, run-length coded: 1 % steps, shared exponent
  Png   // eight bits, tone-mapped: for looking at
};

/// The format that the file name's extension means (.exr, .hdr or .pic, .png); nullopt for any other.
std::optional<ImageFormat> imageFormatOf(const std::filesystem::path&);

/// Writes a picture in the format of its name. .exr carries Radiance's chromaticities, the efficacy and the view; .hdr
/// VIEW= and EXPOSURE=. `mapping` matters to .png alone. Throws OutputError.
void saveImage(const std::filesystem::path&, const Image&, const ToneMapping& mapping = {});
/// Writes a .png. Throws OutputError.
void saveImage(const std::filesystem::path&, const DisplayImage&);

/// Reads a .exr or .hdr; `pixels` are radiance: a .hdr's exposure and colour correction are divided out. Throws
/// InputError.
Image loadImage(const std::filesystem::path&);

/// The view as Radiance's programs take it: "-vtv -vp x y z -vd x y z -vu x y z -vh h -vv v". `origin` is that of the
/// view's scene.
std::string viewOptions(const View&, const Vec3& origin = Vec3(0));

}  // namespace deltalux
