#pragma once
// The sixteen skies of CIE 171 as its daylight cases use them, written down apart from the library's own: relative
// luminance by gradation and indicatrix, groups I to VI and 1 to 6. [CIE 171, 5.9; ISO 15469]
#include <deltalux/light.hpp>

namespace deltalux::test::cie171 {

constexpr int kSkies = 16;
constexpr int kTraditionalOvercast = 16;  // after the 15 of ISO 15469: (1 + 2 sin gamma) / 3

struct GeneralSky {
  int type = kTraditionalOvercast;  // 1 to 16
  Vec3 sun{0, 0, 1};                // unit

  /// Luminance towards `w` (unit), relative to the zenith's; 0 below the horizon.
  double operator()(const Vec3& w) const;
};

/// The same for a scene, of that luminance at the zenith [cd/m2]; nothing shines from below the horizon.
DomeLight skyLight(const GeneralSky&, double zenith);

}  // namespace deltalux::test::cie171
