#include "particles/reached_sides.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace deltalux {

namespace {

/// In the order of surfaceSides(): fronts before backs.
auto orderOf(const SurfaceSide& s) { return std::tuple(s.primitive, s.triangle, !s.front); }

bool before(const SurfaceSide& a, const SurfaceSide& b) { return orderOf(a) < orderOf(b); }

double areaOf(const Scene& scene, const SurfaceSide& s) {
  const Shape& shape = scene[s.primitive].shape;
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return area(shape);
  return mesh->cumulativeArea[s.triangle] - (s.triangle > 0 ? mesh->cumulativeArea[s.triangle - 1] : 0.0);
}

}  // namespace

void addReachedSides(std::vector<SurfaceSide>& sides, const Particles& particles, const Scene& scene) {
  std::vector<std::uint32_t> all(particles.paths());
  std::iota(all.begin(), all.end(), 0u);
  addReachedSides(sides, particles, all, scene);
}

void addReachedSides(std::vector<SurfaceSide>& sides, const Particles& particles, std::span<const std::uint32_t> paths,
                     const Scene& scene) {
  std::map<std::pair<PrimitiveId, std::uint32_t>, RgbSum> flux;  // by primitive, triangle and side
  for (const std::uint32_t path : paths) {
    const double power =
        double(particles.links[particles.link[path]].scale) * particles.nominal[particles.sender[path]];
    for (std::uint32_t i = particles.firstImpact(path); i < particles.endImpact(path); ++i)
      flux[{particles.primitive[i], particles.triangleAndSide[i]}] += power * RgbSum(particles.throughput[i]);
  }
  std::vector<SurfaceSide> added;
  for (const auto& [where, power] : flux) {
    SurfaceSide s{where.first, where.second >> 1, (where.second & 1) == 0, 0, Rgb(0.0f), 0};
    if (std::binary_search(sides.begin(), sides.end(), s, before)) continue;
    const double A = areaOf(scene, s);
    s.irradiance = Rgb(power / A);
    s.typicalIrradiance = gray(s.irradiance);
    s.meanFreePath = static_cast<float>(std::sqrt(A));
    added.push_back(s);
  }
  sides.insert(sides.end(), added.begin(), added.end());
  std::sort(sides.begin(), sides.end(), before);
}

void dropReachedSides(std::vector<SurfaceSide>& sides, const Particles& particles) {
  if (sides.empty()) return;
  const PrimitiveId last = sides.back().primitive;
  std::vector<char> asked(last.index() + 1, 0), reached(sides.size(), 0);
  for (const SurfaceSide& s : sides) asked[s.primitive.index()] = 1;
  for (std::size_t path = 0; path < particles.paths(); ++path)
    for (std::uint32_t i = particles.firstImpact(path); i < particles.endImpact(path); ++i) {
      const PrimitiveId primitive = particles.primitive[i];
      if (primitive > last || !asked[primitive.index()]) continue;
      const std::uint32_t side = particles.triangleAndSide[i];
      const SurfaceSide landed{primitive, side >> 1, (side & 1) == 0, 0, Rgb(0.0f), 0};
      const auto at = std::lower_bound(sides.begin(), sides.end(), landed, before);
      if (at != sides.end() && !before(landed, *at)) reached[static_cast<std::size_t>(at - sides.begin())] = 1;
    }
  std::vector<SurfaceSide> others;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (!reached[i]) others.push_back(sides[i]);
  sides = std::move(others);
}

}  // namespace deltalux
