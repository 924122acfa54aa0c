#pragma once

namespace deltalux {

/// The error of irradiance that numbers of rays, lines and widths are given for, which is what solves have by default:
/// they are scaled from it to what is asked for.
inline constexpr double kUsualError = 0.05;  // [defined]

}  // namespace deltalux
