#include "direct/dim_direct.hpp"

#include <algorithm>
#include <utility>

#include "direct/open_light.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::direct {

namespace {

constexpr std::uint64_t kDimKey = 0x64696d5f5f5f5f5full;  // [key]

}  // namespace

DimDirect dimDirect(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                    const Lamps& lamps, hierarchy::ElementId leaf, std::span<const std::uint32_t> points) {
  DimDirect result;
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  const hierarchy::LeafSequence sequence(elements, scene, leaf);
  const std::uint64_t key = combineKeys(sequence.key(), kDimKey);
  LampTree::Cut all;
  lamps.tree().cut(g, 1, 0, 0, all);
  const ScrambledSobol choices(combineKeys(key, lamps.all().size()));
  std::vector<LampLight> passed;
  double sum = 0, squares = 0;
  for (const std::uint32_t k : points) {
    const hierarchy::PatchPoint x = sequence.point(k);
    double found = 0;
    const auto ask = [&](LightId id, double chance) {
      const ScrambledSobol numbers(combineKeys(key, id.value));
      const OpenLight light = openLight(lamps.sampler(), id, x, numbers(k));
      if (isBlack(light.E)) return;
      ++result.rays;
      const Rgb E = light.E * tracer.transmittance(light.ray(x)) / static_cast<float>(chance);
      if (isBlack(E)) return;
      passed.push_back({id, E, 0, 0});
      found += gray(E);
    };
    for (const std::uint32_t i : lamps.suns())
      if (potential(lamps.all()[i], g) > 0) ask(lamps.all()[i].id, 1);
    if (all.restMost > 0)
      if (const auto drawn = lamps.tree().draw(all, g, choices(k).x)) ask(lamps.all()[drawn->lamp].id, drawn->chance);
    sum += found, squares += found * found;
  }
  const auto n = static_cast<double>(points.size());
  const double variance = n > 1 ? std::max(0.0, squares / n - (sum / n) * (sum / n)) / (n - 1) : 0.0;
  addDrawn(result.lamps, std::move(passed), static_cast<int>(points.size()), variance);
  return result;
}

}  // namespace deltalux::direct
