#include "base/parallel.hpp"
#include "hierarchy/side_locator.hpp"
#include "particles/particles.hpp"

namespace deltalux::particles {

std::vector<Impact> impacts(const Particles& p, const hierarchy::Elements& elements, const Scene& scene) {
  const hierarchy::SideLocator locator(elements, scene);
  std::vector<std::uint32_t> first(p.paths() + 1, 0);
  for (std::size_t path = 0; path < p.paths(); ++path) first[path + 1] = first[path] + p.range[path].impacts;
  std::vector<Impact> result(first.back());
  parallelFor(p.paths(), 1024, [&](std::size_t path) {
    if (p.range[path].impacts == 0) return;
    const SenderCell& cell = p.senderCells[p.sender[path]];
    Rgb power(0.0f);
    if (cell.kind == SenderKind::Side) {
      const hierarchy::ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
      if (side.valid()) power = elements.radiometry[locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.index()].B;
    } else {
      power = scene[cell.light].scale;
    }
    power *= p.links[p.link[path]].scale;
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      result[first[path] + i - p.firstImpact(path)] = {
          p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0, p.uv[i], power * p.throughput[i]};
  });
  return result;
}

}  // namespace deltalux::particles
