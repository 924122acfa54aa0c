#include "direct/dim_direct.hpp"

#include <cmath>

#include "direct/open_light.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::direct {

namespace {

constexpr std::uint64_t kDimKey = 0x64696d5f5f5f5f5full;

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
  RgbSum sum(0.0);
  double squares = 0;
  for (const std::uint32_t k : points) {
    const hierarchy::PatchPoint x = sequence.point(k);
    Rgb found(0.0f);
    const auto ask = [&](LightId id, double chance) {
      const ScrambledSobol numbers(combineKeys(key, id.value));
      const OpenLight light = openLight(lamps.sampler(), id, x, numbers(k));
      if (isBlack(light.E)) return;
      ++result.rays;
      found += light.E * tracer.transmittance(light.ray(x)) / static_cast<float>(chance);
    };
    for (const std::uint32_t i : lamps.suns())
      if (potential(lamps.all()[i], g) > 0) ask(lamps.all()[i].id, 1);
    if (all.restMost > 0)
      if (const auto drawn = lamps.tree().draw(all, g, choices(k).x)) ask(lamps.all()[drawn->lamp].id, drawn->chance);
    sum += RgbSum(found), squares += double(gray(found)) * gray(found);
  }
  const auto n = static_cast<double>(points.size());
  if (!(n > 0)) return result;
  result.E = Rgb(sum / n);
  const double mean = gray(result.E);
  if (n > 1) result.deviation = static_cast<float>(std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1)));
  return result;
}

}  // namespace deltalux::direct
