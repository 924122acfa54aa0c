#pragma once
// Exponentials and logarithms to four digits and more, in a form that compilers make vector code of.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace deltalux::caustics {

/// exp(x), x in [-87, 88]; 1e-38 below.
inline float expOf(float x) {
  const float powers = std::max(-126.0f, 1.44269504f * x), whole = std::floor(powers);
  const float part = (powers - whole) * 0.693147181f;
  const float series =
      1 + part * (1 + part * (0.5f + part * (1.6666667e-1f +
                                             part * (4.1666667e-2f + part * (8.3333333e-3f + part * 1.3888889e-3f)))));
  return std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23) * series;
}

/// log(x), x > 0 and not denormal.
inline float logOf(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  // x = m 2^e with m in [sqrt 1/2, sqrt 2); log m = 2 artanh((m - 1) / (m + 1))
  const std::int32_t e = (bits - 0x3f3504f3) >> 23;
  const float m = std::bit_cast<float>(bits - (e << 23)), s = (m - 1) / (m + 1), q = s * s;
  return 0.693147181f * static_cast<float>(e) +
         2 * s * (1 + q * (0.333333333f + q * (0.2f + q * (0.142857143f + q * 0.111111111f))));
}

}  // namespace deltalux::caustics
