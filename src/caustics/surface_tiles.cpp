#include "caustics/surface_tiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/tuning.hpp"
#include "particles/side_index.hpp"

namespace deltalux::caustics {

SurfaceTiles::SurfaceTiles(const Scene& scene, const particles::Particles& p) : scene_(scene) {
  sides_.resize(2 * scene.primitives.size());
  std::vector<std::uint32_t> impacts(sides_.size(), 0);
  for (std::size_t path = 0; path < p.paths(); ++path)
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) ++impacts[particles::sideIndex(p, i)];
  for (std::size_t side = 0; side < sides_.size(); ++side)
    if (impacts[side] > 0)
      cut(side,
          std::bit_floor(static_cast<std::uint32_t>(std::clamp(
              std::sqrt(impacts[side] / deltalux::tuning::kFewestEstimates), 1.0, double(deltalux::tuning::kPilots)))));
}

void SurfaceTiles::cut(std::size_t side, std::uint32_t across) {
  const double whole = area(scene_.primitives[side / 2].shape);
  sides_[side] = {tiles_, across, static_cast<float>(whole / (across * across))};
  tiles_ += across * across;
}

std::uint32_t SurfaceTiles::tileOf(const particles::Particles& p, std::uint32_t impact) {
  const std::size_t index = particles::sideIndex(p, impact);
  if (sides_[index].across == 0) cut(index, 1);
  const Side& side = sides_[index];
  if (side.across == 1) return side.first;
  if (const auto* mesh = std::get_if<Mesh>(&scene_[p.primitive[impact]].shape)) {
    const std::uint64_t triangle = p.triangleAndSide[impact] >> 1;
    return side.first + static_cast<std::uint32_t>(triangle * side.count() / mesh->triangles.size());
  }
  const auto along = [&](double u) {
    return static_cast<std::uint32_t>(std::clamp(u * side.across, 0.0, side.across - 1.0));
  };
  return side.first + along(p.uv[impact].y) * side.across + along(p.uv[impact].x);
}

}  // namespace deltalux::caustics
