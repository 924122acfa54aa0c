#pragma once
// Numbers in forms that gzip makes small: as differences, and bytes of one significance side by side.
#include <cstdint>
#include <span>
#include <string>

namespace deltalux::exporting {

/// Differences from one number to the next (the first: from 0), signs folded in (0, -1, 1, -2 as 0, 1, 2, 3); then all
/// lowest bytes, all second ones, and so on: 4 bytes a number. Numbers are below 2^30 in size.
std::string differencePlanes(std::span<const std::int32_t> numbers);

/// RGB9E5 words as five planes of bytes. A word is told from the one before it (the first: from 0): its exponent less
/// that one's, modulo 256; then, as light keeps its colour from place to place, what mantissas are off from
///
///     green'  of green before it at the same light,  red'  and  blue'  of red and blue before it by green now / before
///
/// (rounded, at most 511), signs folded in: lowest bytes of red, green and blue, and their upper two bits each in one
/// byte, red's lowest.
///
/// `slack`: by word, by how much its mantissas may come back otherwise, for the differences to be round (empty: 0).
std::string rgb9e5Planes(std::span<const std::uint32_t> words, std::span<const std::uint8_t> slack = {});

}  // namespace deltalux::exporting
