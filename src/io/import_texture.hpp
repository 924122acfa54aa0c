#pragma once
// Image files (PNG, JPEG, BMP, TGA, GIF) as linear textures.
#include <array>
#include <deltalux/scene.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace deltalux::io {

/// How the numbers of an image mean quantities.
enum class TexelEncoding { Srgb, Linear };

/// Red, green and blue of an image, linear in [0,1]; nullopt when the bytes are no image of a usable size.
std::optional<Texture> decodeTexture(std::string_view bytes, std::string name, TexelEncoding);

/// How many of an image's texels, as a share, have each of 256 alphas; all of them the last in one without alpha.
/// nullopt as above.
std::optional<std::array<double, 256>> alphaShares(std::string_view bytes);

/// The mean texel.
Rgb average(const Texture&);

}  // namespace deltalux::io
