#pragma once
// The two sides of every primitive in one order, for tables by side.
#include "particles/particles.hpp"

namespace deltalux::particles {

inline std::size_t sideIndex(PrimitiveId primitive, bool front) { return 2 * primitive.index() + (front ? 0 : 1); }

/// Of the side that an impact is on.
inline std::size_t sideIndex(const Particles& p, std::uint32_t impact) {
  return sideIndex(p.primitive[impact], (p.triangleAndSide[impact] & 1) == 0);
}

}  // namespace deltalux::particles
