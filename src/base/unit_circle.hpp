#pragma once
// Cosine and sine of an angle that is given in turns, as places on circles are: taking whole quarters off loses
// nothing, and on what is left, an eighth of a turn at most, their power series end soon. Within 3e-15 of the library's
// functions, which take any angle in radians and keep the last digit, in some three fifths of their time.
#include <cmath>
#include <deltalux/math.hpp>

namespace deltalux {

/// (cos, sin) of 2 pi `turns`.
inline Vec2 onUnitCircle(double turns) {
  const double quarters = std::nearbyint(4 * turns);
  const double x = 0.5 * kPi * (4 * turns - quarters);
  const double x2 = x * x, x4 = x2 * x2, x8 = x4 * x4;
  const double s = x * (((1 - x2 / 6) + x4 * (1 / 120.0 - x2 / 5040)) +
                        x8 * ((1 / 362880.0 - x2 / 39916800) + x4 * (1 / 6227020800.0 - x2 / 1307674368000)));
  const double c = ((1 - x2 / 2) + x4 * (1 / 24.0 - x2 / 720)) +
                   x8 * ((1 / 40320.0 - x2 / 3628800) + x4 * (1 / 479001600.0 - x2 / 87178291200));
  const auto quadrant = static_cast<unsigned>(static_cast<long long>(quarters));
  const bool swapped = quadrant & 1;
  const double a = swapped ? s : c, b = swapped ? c : s;
  return {(quadrant + 1) & 2 ? -a : a, quadrant & 2 ? -b : b};
}

}  // namespace deltalux
