#include "engine/relight.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "lines/iterate.hpp"
#include "lines/tuning.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::engine {

namespace {
constexpr std::size_t kRelitLeaves = 1024;  // of a task [task]
constexpr std::size_t kAhead = 8;           // leaves, whose lamps memory is asked for [task]
}  // namespace

LampsOfLeaves lampsOf(const PatchSamples& samples, std::span<const DimLeaf> dimLeaves,
                      const hierarchy::LeafTable& leaves) {
  LampsOfLeaves all(leaves.size());
  parallelFor(leaves.size(), kRelitLeaves, [&](std::size_t i) { all[i] = samples.direct[leaves[i].index()].lamps; });
  for (const DimLeaf& dim : dimLeaves) all[leaves.indexOf[dim.leaf.index()]] = dim.light.lamps;
  return all;
}

Dimming Dimming::none(const Scene& scene) { return {std::vector<Rgb>(scene.lights.size(), Rgb(1.0f)), Rgb(1.0f)}; }

Dimming Dimming::of(const Scene& scene, const direct::Skies& skies) { return {scene::dimming(scene), skies.dimming()}; }

void relight(Solution& s, const hierarchy::LeafTable& leaves, lines::Exchange& exchange, const LampsOfLeaves& lamps,
             const KnownSky& sky, const Dimming& dimming, double converged) {
  hierarchy::Elements& elements = s.elements;
  const std::size_t n = leaves.size();
  lines::LeafLight light = lines::leafLight(elements, leaves);
  std::vector<float> deviation(n);
  parallelFor(n, kRelitLeaves, [&](std::size_t i) {
    hierarchy::ElementLight& l = elements.radiometry[leaves[i].index()];
    if (i + kAhead < n) prefetch(lamps[i + kAhead]);
    const direct::DimmedLight direct = direct::dimmed(lamps[i], dimming.lights);
    const double lamp = direct.deviation, dome = double(gray(dimming.skies)) * sky.at[i].deviation;
    deviation[i] = static_cast<float>(std::sqrt(lamp * lamp + dome * dome));
    l.direct = exchange.area(i) > 0 ? direct.E + dimming.skies * sky.at[i].E : Rgb(0.0f);
    light.source[i] = l.direct + l.particle, light.indirect[i] = l.indirect;
  });
  const lines::IterationReport iterated = lines::iterate(exchange, light, converged, lines::kMostPasses);
  s.report.counts.iterations += static_cast<std::uint64_t>(iterated.passes);
  s.deviation.resize(n);
  exchange.deviation(light.B, s.deviation);
  parallelFor(n, kRelitLeaves, [&](std::size_t i) {
    hierarchy::ElementLight& l = elements.radiometry[leaves[i].index()];
    l.indirect = light.indirect[i], l.B = light.B[i];
    s.deviation[i] = std::hypot(s.deviation[i], deviation[i]);
  });
}

}  // namespace deltalux::engine
