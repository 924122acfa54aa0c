#include "caustics/surface_impacts.hpp"

namespace deltalux::caustics {

std::vector<std::vector<ChartImpact>> placeImpacts(const Shape& shape, const Charts& charts,
                                                   std::span<const particles::Impact> impacts) {
  std::vector<std::vector<ChartImpact>> placed(charts.all.size());
  for (const particles::Impact& impact : impacts) {
    const std::size_t chart = charts.indexOf(impact.triangle);
    const Vec2 st = charts.all[chart].place(impactPoint(shape, impact.uv, impact.triangle));
    placed[chart].push_back({st, impact.flux});
  }
  return placed;
}

}  // namespace deltalux::caustics
