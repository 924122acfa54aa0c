#include "radiosity/coarse_solution.hpp"

#include "base/parallel.hpp"
#include "radiosity/side_estimator.hpp"

namespace deltalux {

std::vector<SurfaceSide> coarseSolution(const Scene& scene, const RayTracer& tracer, CoarseReport* report) {
  SideEstimator estimator(scene, tracer);
  const std::size_t n = estimator.sides().size();
  parallelFor(n, 32, [&](std::size_t i) { estimator.estimate(i); });
  std::vector<SurfaceSide> result;
  for (std::size_t i = 0; i < n; ++i)
    if (estimator.reached(i)) result.push_back(estimator.estimated(i));
  if (report) *report = {estimator.rays(), n, result.size()};
  return result;
}

}  // namespace deltalux
