#include "radiosity/parted_leaf.hpp"

#include <cmath>

#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "paper/sender_sampling.hpp"

namespace deltalux::radiosity {

bool standsBetween(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                   hierarchy::ElementId leaf, std::size_t a, std::size_t b) {
  constexpr int kLines = 16, kEnough = 4;
  constexpr float kLow = 0.02f, kHigh = 0.2f;  // above the leaf, by turns, in its sides: what is lower parts nothing
  if (!elements.at(leaf).flat) return false;
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  const float side = std::sqrt(g.area);
  const std::uint64_t key = combineKeys(elements.key[leaf.index()], 9);
  const auto pointIn = [&](std::size_t quadrant, double u, double v) {
    return hierarchy::samplePatch(elements, scene, leaf, 0.5 * (u + static_cast<double>(quadrant % 2)),
                                  0.5 * (v + static_cast<double>(quadrant / 2)))
        .position;
  };
  int blocked = 0;
  for (int i = 0; i < kLines; ++i) {
    const auto u = paper::stratified4(key, i);
    const Vec3f up = (i % 2 == 0 ? kLow : kHigh) * side * g.normal;
    blocked += tracer.occluded(
        tracing::segment(pointIn(a, u[0], u[1]) + up, Vec3f(0.0f), pointIn(b, u[2], u[3]) + up, Vec3f(0.0f)));
  }
  return blocked >= kEnough;
}

}  // namespace deltalux::radiosity
