#include "render/particle_paths.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/parallel.hpp"
#include "particles/impact_light.hpp"
#include "scene/nominal_scale.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kPathBlock = 4096;  // [task]

struct PlacedDeposits {
  double squared;  // of its distance
  std::uint32_t path, impact;
};

/// Impacts on the side of the spot, nearest first.
std::vector<PlacedDeposits> nearestImpacts(const Solution& s, const SurfaceSpot& spot) {
  const particles::Particles& p = s.particles;
  std::vector<std::vector<PlacedDeposits>> found((p.paths() + kPathBlock - 1) / kPathBlock);
  const auto nearer = [](const PlacedDeposits& a, const PlacedDeposits& b) {
    return std::tie(a.squared, a.impact) < std::tie(b.squared, b.impact);
  };
  const auto keepNearest = [&](std::vector<PlacedDeposits>& all) {
    const std::size_t most = std::min(all.size(), kMostParticles);
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most), all.end(), nearer);
    all.resize(most);
  };
  parallelFor(p.paths(), kPathBlock, [&](std::size_t path) {
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      const std::uint32_t where = p.triangleAndSide[i];
      if (p.primitive[i] != spot.primitive || ((where & 1) == 0) != spot.front) continue;
      const particles::Impact impact{p.primitive[i], where >> 1, spot.front, p.uv[i], Rgb(0.0f)};
      const Vec3 d = particles::positionOf(impact, s.scene) - spot.position;
      found[path / kPathBlock].push_back({glm::dot(d, d), static_cast<std::uint32_t>(path), i});
    }
  });
  std::vector<PlacedDeposits> all;
  for (std::vector<PlacedDeposits>& part : found) {
    keepNearest(part);
    all.insert(all.end(), part.begin(), part.end());
  }
  keepNearest(all);
  return all;
}

/// Vertices of the path up to where it was deposited: the one nearest to that.
std::size_t cornersUntil(const Solution& s, const PlacedDeposits& deposited) {
  const particles::Particles& p = s.particles;
  const std::uint32_t where = p.triangleAndSide[deposited.impact];
  const Vec3 at = particles::positionOf(
      {p.primitive[deposited.impact], where >> 1, (where & 1) == 0, p.uv[deposited.impact], Rgb(0.0f)}, s.scene);
  const auto vertices = p.verticesOf(deposited.path);
  const auto met = p.metBy(deposited.path);
  std::size_t best = vertices.size() - 1;
  double least = kInfinity;
  for (std::size_t v = 1; v < vertices.size(); ++v) {
    const double away = glm::length(Vec3(vertices[v]) - at);
    if (met[v] == p.primitive[deposited.impact] && away < least) least = away, best = v;
  }
  return best + 1;
}

}  // namespace

std::vector<Contributions::Path> particlePathsAt(const Solution& s, const SurfaceSpot& spot, const Rgb& light) {
  struct Group {
    RgbSum flux{0.0};
    std::uint64_t particles = 0;
    std::vector<Vec3> corners;  // of the nearest
  };
  const hierarchy::SideLocator locator(s.elements, s.scene);
  std::map<std::vector<PrimitiveId>, Group> groups;
  const std::vector<Rgb> scales = scene::scalesOf(s.scene);
  RgbSum all(0.0);
  for (const PlacedDeposits& deposited : nearestImpacts(s, spot)) {
    const std::size_t corners = cornersUntil(s, deposited);
    const auto vertices = s.particles.verticesOf(deposited.path).first(corners);
    const auto met = s.particles.metBy(deposited.path).first(corners);
    Group& group = groups[{met.begin(), met.end()}];
    if (group.corners.empty()) {
      for (const Vec3f& v : vertices) group.corners.push_back(Vec3(v));
      group.corners.back() = spot.position;
    }
    const RgbSum flux(particles::powerOf(s.particles, deposited.path, s.elements, locator, scales) *
                      s.particles.throughput[deposited.impact]);
    group.flux += flux, all += flux, ++group.particles;
  }
  std::vector<Contributions::Path> paths;
  for (auto& [surfaces, group] : groups) {
    RgbSum E(0.0);
    for (int c = 0; c < 3; ++c)
      if (all[c] > 0) E[c] = double(light[c]) * group.flux[c] / all[c];
    if (gray(E) > 0) paths.push_back({std::move(group.corners), E, group.particles});
  }
  std::stable_sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return gray(a.E) > gray(b.E); });
  return paths;
}

}  // namespace deltalux::rendering
