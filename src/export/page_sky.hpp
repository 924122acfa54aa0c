#pragma once
// What is seen beyond all surfaces: skies and suns, by group of lights.
#include <deltalux/light_groups.hpp>
#include <optional>
#include <vector>

namespace deltalux::exporting {

constexpr int kSkyWidth = 128, kSkyHeight = 64;  // of a table: 2.8 degrees a texel [shown]

/// Radiance [W/(sr m2)] by azimuth from -180 to 180 degrees about +z and polar angle from +z, row by row from the
/// zenith, kSkyWidth x kSkyHeight.
struct PageSky {
  std::optional<std::size_t> group;  // none: of backdrops, whatever lights there are
  std::vector<Rgb> radiance;         // of the group's lights at the scale that pageLights() counts from
};

struct PageSun {
  std::size_t group = 0;
  Vec3 direction{0, 0, 1};  // unit, towards it
  double angularRadius = 0;
  Rgb radiance{0.0f};
};

/// `present`: at the scene's present scales, else at scale 1.
std::vector<PageSky> pageSkies(const Scene&, const std::vector<LightGroup>&, bool present);
std::vector<PageSun> pageSuns(const Scene&, const std::vector<LightGroup>&, bool present);

}  // namespace deltalux::exporting
