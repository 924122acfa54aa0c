#include "radiosity/coarse_solution.hpp"

#include <atomic>
#include <numeric>

#include "base/parallel.hpp"
#include "radiosity/side_estimator.hpp"

namespace deltalux {

std::vector<SurfaceSide> coarseSolution(const Scene& scene, const RayTracer& tracer, CoarseReport* report) {
  std::vector<SurfaceSide> sides = surfaceSides(scene);
  const SideEstimator estimator(scene, tracer, sides.size());
  SideTable<char> lit;
  for (const SurfaceSide& s : sides) lit.add(s.side());
  std::vector<std::uint64_t> rays(sides.size(), 0);
  const auto setLit = [&](const Side& s) { std::atomic_ref(*lit.find(s)).store(1, std::memory_order_relaxed); };
  parallelFor(sides.size(), 32, [&](std::size_t i) {
    const SideEstimate e = estimator.estimate(sides[i].side());
    sides[i] = e.side;
    rays[i] = e.rays;
    if (!isBlack(e.side.irradiance)) setLit(e.side.side());
    for (const Side& s : e.lit) setLit(s);
  });
  std::vector<SurfaceSide> result;
  for (const SurfaceSide& s : sides)
    if (isReached(scene, s.side(), [&](const Side& side) { return lit.at(side) != 0; })) result.push_back(s);
  if (report) *report = {std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}), sides.size(), result.size()};
  return result;
}

}  // namespace deltalux
