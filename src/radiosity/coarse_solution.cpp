#include "radiosity/coarse_solution.hpp"

#include <atomic>
#include <numeric>
#include <span>

#include "base/parallel.hpp"
#include "radiosity/side_estimator.hpp"

namespace deltalux {

namespace {

/// The places of sides in surfaceSides().
class SideOrder {
 public:
  SideOrder(const Scene& scene, std::span<const SurfaceSide> sides)
      : first_(scene.primitives.size(), 0), step_(scene.primitives.size(), 1) {
    for (std::size_t i = sides.size(); i-- > 0;) {
      first_[sides[i].primitive.index()] = i;
      if (!sides[i].front) step_[sides[i].primitive.index()] = 2;  // has back sides too
    }
  }

  std::size_t of(const Side& s) const {
    const std::size_t step = step_[s.primitive.index()];
    return first_[s.primitive.index()] + step * s.triangle + (step == 2 && !s.front ? 1 : 0);
  }

 private:
  std::vector<std::size_t> first_, step_;  // by primitive
};

}  // namespace

std::vector<SurfaceSide> coarseSolution(const Scene& scene, const RayTracer& tracer, CoarseReport* report) {
  std::vector<SurfaceSide> sides = surfaceSides(scene);
  const SideOrder order(scene, sides);
  const SideEstimator estimator(scene, tracer, sides.size());
  std::vector<char> lit(sides.size(), 0);
  std::vector<std::uint64_t> rays(sides.size(), 0);
  const auto setLit = [&](std::size_t i) { std::atomic_ref(lit[i]).store(1, std::memory_order_relaxed); };
  parallelFor(sides.size(), 32, [&](std::size_t i) {
    const SideEstimate e = estimator.estimate(sides[i].side());
    sides[i] = e.side;
    rays[i] = e.rays;
    if (!isBlack(e.side.irradiance)) setLit(i);
    for (const Side& s : e.lit) setLit(order.of(s));
  });
  std::vector<SurfaceSide> result;
  for (const SurfaceSide& s : sides)
    if (isReached(scene, s.side(), [&](const Side& side) { return lit[order.of(side)] != 0; })) result.push_back(s);
  if (report) *report = {std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}), sides.size(), result.size()};
  return result;
}

}  // namespace deltalux
