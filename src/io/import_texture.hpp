#pragma once
// Image files (PNG, JPEG, BMP, TGA, GIF) as linear textures.
#include <deltalux/scene.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace deltalux::io {

/// How the numbers of an image mean quantities.
enum class TexelEncoding { Srgb, Linear };

/// Red, green and blue of an image, linear in [0,1]; nullopt when the bytes are no image of a usable size.
std::optional<Texture> decodeTexture(std::string_view bytes, std::string name, TexelEncoding);

/// The mean texel.
Rgb average(const Texture&);

}  // namespace deltalux::io
