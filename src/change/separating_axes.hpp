#pragma once
// Segments against boxes without divisions and cases, so that passes over many of either are vector code.
#include <algorithm>
#include <cmath>

namespace deltalux::change {

/// How far a segment from the origin to 2 w is from a box of half the size h about c, along the one of six axes that
/// tells most, each in its own measure: those of the box, and those at right angles to one and the segment. Above zero
/// where they do not meet; only then, too, but where the segment lies along an axis.
inline float apart(float cx, float cy, float cz, float hx, float hy, float hz, float wx, float wy, float wz) {
  const float ax = std::abs(wx), ay = std::abs(wy), az = std::abs(wz);
  return std::max({std::abs(cx - wx) - (hx + ax), std::abs(cy - wy) - (hy + ay), std::abs(cz - wz) - (hz + az),
                   std::abs(cy * wz - cz * wy) - (hy * az + hz * ay), std::abs(cz * wx - cx * wz) - (hz * ax + hx * az),
                   std::abs(cx * wy - cy * wx) - (hx * ay + hy * ax)});
}

}  // namespace deltalux::change
