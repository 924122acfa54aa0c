#pragma once
#include <cstdint>

namespace deltalux {

/// The place of a cell of a grid along the curve that keeps neighbours together: bits of x at the even places of the
/// result, of y at the odd ones. [Morton66]
inline std::uint64_t morton(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint64_t b) {
    b = (b | b << 16) & 0x0000ffff0000ffffull;
    b = (b | b << 8) & 0x00ff00ff00ff00ffull;
    b = (b | b << 4) & 0x0f0f0f0f0f0f0f0full;
    b = (b | b << 2) & 0x3333333333333333ull;
    return (b | b << 1) & 0x5555555555555555ull;
  };
  return spread(x) | spread(y) << 1;
}

/// The same in space, of cells by 20 bits along each axis: z at the lowest places.
inline std::uint64_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const auto spread = [](std::uint64_t b) {
    b = (b | b << 32) & 0x001f00000000ffffull;
    b = (b | b << 16) & 0x001f0000ff0000ffull;
    b = (b | b << 8) & 0x100f00f00f00f00full;
    b = (b | b << 4) & 0x10c30c30c30c30c3ull;
    return (b | b << 2) & 0x1249249249249249ull;
  };
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

}  // namespace deltalux
