#pragma once
// One encoder (and decoder) per picture format, between bytes and pixels; files are the caller's business.
#include <array>
#include <cstdint>
#include <deltalux/image.hpp>
#include <span>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Radiance RGBE. [Radiance, "The RADIANCE Picture File Format"]
std::string encodeHdr(const Image&);
/// Throws InputError in the name of `file`. Reads flat, old and new run lengths and all eight orientations.
Image decodeHdr(std::string_view bytes, const std::string& file);

/// OpenEXR with 32-bit float R, G, B.
std::string encodeExr(const Image&);
Image decodeExr(std::string_view bytes, const std::string& file);

std::string encodePng(const DisplayImage&);
/// With alpha, row by row from the top.
std::string encodePng(int width, int height, std::span<const std::array<std::uint8_t, 4>> rgba);

}  // namespace deltalux::io
