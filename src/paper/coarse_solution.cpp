#include "paper/coarse_solution.hpp"

#include <atomic>
#include <numeric>

#include "base/parallel.hpp"
#include "paper/side_estimator.hpp"

namespace deltalux::paper {

std::vector<hierarchy::SurfaceSide> coarseSolution(const Scene& scene, const tracing::RayTracer& tracer,
                                                   CoarseReport* report) {
  std::vector<hierarchy::SurfaceSide> sides = hierarchy::surfaceSides(scene);
  const SideEstimator estimator(scene, tracer, sides.size());
  hierarchy::SideTable<char> lit;
  for (const hierarchy::SurfaceSide& s : sides) lit.add(s.side());
  std::vector<std::uint64_t> rays(sides.size(), 0);
  const auto setLit = [&](const hierarchy::Side& s) {
    std::atomic_ref(*lit.find(s)).store(1, std::memory_order_relaxed);
  };
  parallelFor(sides.size(), 32, [&](std::size_t i) {
    const SideEstimate e = estimator.estimate(sides[i].side());
    sides[i] = e.side;
    rays[i] = e.rays;
    if (!isBlack(e.side.irradiance)) setLit(e.side.side());
    for (const hierarchy::Side& s : e.lit) setLit(s);
  });
  std::vector<hierarchy::SurfaceSide> result;
  for (const hierarchy::SurfaceSide& s : sides)
    if (isReached(scene, s.side(), [&](const hierarchy::Side& side) { return lit.at(side) != 0; })) result.push_back(s);
  if (report) *report = {std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}), sides.size(), result.size()};
  return result;
}

}  // namespace deltalux::paper
