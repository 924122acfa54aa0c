#include "export/page_sky.hpp"

namespace deltalux::exporting {

namespace {

void addTo(std::vector<Rgb>& table, const DomeLight& dome, const Rgb& scale) {
  table.resize(std::size_t(kSkyWidth) * kSkyHeight, Rgb(0.0f));
  for (int y = 0; y < kSkyHeight; ++y)
    for (int x = 0; x < kSkyWidth; ++x) {
      const double azimuth = 2 * kPi * ((x + 0.5) / kSkyWidth - 0.5), polar = kPi * (y + 0.5) / kSkyHeight;
      const Vec3 w(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
      table[std::size_t(y) * kSkyWidth + x] += scale * skyRadiance(dome, w);
    }
}

}  // namespace

std::vector<PageSky> pageSkies(const Scene& scene, const std::vector<LightGroup>& groups, bool present) {
  std::vector<PageSky> skies;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    PageSky sky{g, {}};
    for (const LightId light : groups[g].lights)
      if (const auto* dome = std::get_if<DomeLight>(&scene[light].emitter))
        addTo(sky.radiance, *dome, present ? scene[light].scale : Rgb(1.0f));
    if (!sky.radiance.empty()) skies.push_back(std::move(sky));
  }
  PageSky backdrop;
  for (const DomeLight& dome : scene.backdrops) addTo(backdrop.radiance, dome, Rgb(1.0f));
  if (!backdrop.radiance.empty()) skies.push_back(std::move(backdrop));
  return skies;
}

std::vector<PageSun> pageSuns(const Scene& scene, const std::vector<LightGroup>& groups, bool present) {
  std::vector<PageSun> suns;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const LightId light : groups[g].lights)
      if (const auto* sun = std::get_if<SunLight>(&scene[light].emitter))
        suns.push_back(
            {g, sun->direction, sun->angularRadius, sun->radiance * (present ? scene[light].scale : Rgb(1.0f))});
  return suns;
}

}  // namespace deltalux::exporting
