#pragma once
// Three numbers of one exponent in 32 bits, as graphics cards read them: red in bits 0 to 8, green 9 to 17, blue 18 to
// 26, exponent 27 to 31; value = mantissa * 2^(exponent - 24) (OpenGL ES 3.0, RGB9_E5).
#include <cstdint>
#include <deltalux/units.hpp>

namespace deltalux::exporting {

/// The nearest that there is: the greatest channel is off by 1/512 of itself at most. Negative and undefined numbers
/// become 0, those above 65408 become that.
std::uint32_t packRgb9e5(const Rgb&);
Rgb unpackRgb9e5(std::uint32_t);

}  // namespace deltalux::exporting
