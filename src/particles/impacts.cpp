#include "base/parallel.hpp"
#include "particles/impact_light.hpp"
#include "particles/particles.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::particles {

Vec3 positionOf(const Impact& impact, const Scene& scene) {
  const Shape& shape = scene[impact.primitive].shape;
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return pointAt(shape, Vec2(impact.uv)).position;
  const auto& t = mesh->triangles[impact.triangle];
  const Vec3 &a = mesh->positions[t[0]], &b = mesh->positions[t[1]], &c = mesh->positions[t[2]];
  return a + double(impact.uv.x) * (b - a) + double(impact.uv.y) * (c - a);
}

Rgb powerOf(const Particles& p, std::size_t path, const hierarchy::Elements& elements,
            const hierarchy::SideLocator& locator, std::span<const Rgb> scales) {
  const SenderCell& cell = p.senderCells[p.sender[path]];
  Rgb power(0.0f);
  if (cell.kind == SenderKind::Side) {
    const hierarchy::ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
    if (side.valid()) power = elements.radiometry[locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.index()].B;
  } else {
    power = scales[cell.light.index()];
  }
  return power * p.links[p.link[path]].scale;
}

std::vector<Impact> impacts(const Particles& p, const hierarchy::Elements& elements, const Scene& scene) {
  return impacts(p, elements, scene, scene::scalesOf(scene));
}

std::vector<Impact> impacts(const Particles& p, const hierarchy::Elements& elements, const Scene& scene,
                            std::span<const Rgb> scales) {
  const hierarchy::SideLocator locator(elements, scene);
  std::vector<std::uint32_t> first(p.paths() + 1, 0);
  for (std::size_t path = 0; path < p.paths(); ++path) first[path + 1] = first[path] + p.range[path].impacts;
  std::vector<Impact> result(first.back());
  parallelFor(p.paths(), 1024, [&](std::size_t path) {
    if (p.range[path].impacts == 0) return;
    const Rgb power = powerOf(p, path, elements, locator, scales);
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      result[first[path] + i - p.firstImpact(path)] = {
          p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0, p.uv[i], power * p.throughput[i]};
  });
  return result;
}

}  // namespace deltalux::particles
