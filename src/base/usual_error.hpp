#pragma once

namespace deltalux {

/// The error of irradiance that numbers of rays, lines and widths are given for, which is what solves have by default:
/// they are scaled from it to what is asked for.
inline constexpr double kUsualError = 0.05;  // [defined]
/// Independent samples whose mean has that error, where they differ by as much as they are.
inline constexpr double kSamplesOfUsualError = 1 / (kUsualError * kUsualError);  // [defined]

}  // namespace deltalux
