#include "caustics/surface_impacts.hpp"

namespace deltalux::caustics {

namespace {

/// Of the only chart of a plane shape, whose parameters are lengths along two edges, as most are.
std::vector<ChartImpact> placeOnPlane(const Polygon& p, const PlaneChart& plane,
                                      std::span<const particles::Impact> impacts) {
  std::vector<ChartImpact> placed;
  placed.reserve(impacts.size());
  for (const particles::Impact& impact : impacts) {
    const Vec2 uv(impact.uv);
    const Vec3 d = p.origin + uv.x * p.edgeU + uv.y * p.edgeV - plane.origin;
    placed.push_back({{glm::dot(d, plane.alongS), glm::dot(d, plane.alongT)}, impact.flux});
  }
  return placed;
}

}  // namespace

std::vector<std::vector<ChartImpact>> placeImpacts(const Shape& shape, const Charts& charts,
                                                   std::span<const particles::Impact> impacts) {
  std::vector<std::vector<ChartImpact>> placed(charts.all.size());
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    placed.front() = placeOnPlane(*polygon, std::get<PlaneChart>(charts.all.front().map), impacts);
    return placed;
  }
  for (const particles::Impact& impact : impacts) {
    const std::size_t chart = charts.indexOf(impact.triangle);
    const Vec2 st = charts.all[chart].place(impactPoint(shape, impact.uv, impact.triangle));
    placed[chart].push_back({st, impact.flux});
  }
  return placed;
}

}  // namespace deltalux::caustics
