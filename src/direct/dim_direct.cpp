#include "direct/dim_direct.hpp"

#include <algorithm>
#include <utility>

#include "direct/open_light.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::direct {

namespace {

constexpr std::uint64_t kDimKey = 0x64696d5f5f5f5f5full;  // [key]

/// The shadow rays of a leaf: every sun and one lamp from each point.
class DimRays {
 public:
  DimRays(const hierarchy::Elements& elements, const Scene& scene, const Lamps& lamps, hierarchy::ElementId leaf)
      : lamps_(lamps),
        g_(elements.shape(leaf)),
        sequence_(elements, scene, leaf),
        key_(combineKeys(sequence_.key(), kDimKey)),
        choices_(combineKeys(key_, lamps.all().size())) {
    lamps.tree().cut(g_, 1, 0, 0, all_);
  }

  /// visit(lamp, what it would bring over its chance, ray) from point k, of those that shine there.
  template <class Visit>
  void from(std::uint32_t k, const Visit& visit) const {
    const hierarchy::PatchPoint x = sequence_.point(k);
    const auto ask = [&](LightId id, double chance) {
      const ScrambledSobol numbers(combineKeys(key_, id.value));
      const OpenLight light = openLight(lamps_.sampler(), id, x, numbers(k));
      if (!isBlack(light.E)) visit(id, light.E / static_cast<float>(chance), light.ray(x));
    };
    for (const std::uint32_t i : lamps_.suns())
      if (potential(lamps_.all()[i], g_) > 0) ask(lamps_.all()[i].id, 1);
    if (all_.restMost > 0)
      if (const auto drawn = lamps_.tree().draw(all_, g_, choices_(k).x))
        ask(lamps_.all()[drawn->lamp].id, drawn->chance);
  }

 private:
  const Lamps& lamps_;
  const hierarchy::ElementGeometry& g_;
  hierarchy::LeafSequence sequence_;
  std::uint64_t key_;
  ScrambledSobol choices_;
  LampTree::Cut all_;
};

}  // namespace

DimDirect dimDirect(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                    const Lamps& lamps, hierarchy::ElementId leaf, std::span<const std::uint32_t> points) {
  DimDirect result;
  const DimRays rays(elements, scene, lamps, leaf);
  std::vector<LampLight> passed;
  double sum = 0, squares = 0;
  for (const std::uint32_t k : points) {
    double found = 0;
    rays.from(k, [&](LightId id, const Rgb& open, const tracing::Ray& ray) {
      ++result.rays;
      const Rgb E = open * tracer.transmittance(ray);
      if (isBlack(E)) return;
      passed.push_back({id, E, 0, 0});
      found += gray(E);
    });
    sum += found, squares += found * found;
  }
  const auto n = static_cast<double>(points.size());
  const double variance = n > 1 ? std::max(0.0, squares / n - (sum / n) * (sum / n)) / (n - 1) : 0.0;
  addDrawn(result.lamps, std::move(passed), static_cast<int>(points.size()), variance);
  return result;
}

bool anyDimRay(const hierarchy::Elements& elements, const Scene& scene, const Lamps& lamps, hierarchy::ElementId leaf,
               std::span<const std::uint32_t> points, const std::function<bool(const tracing::Ray&)>& stops) {
  const DimRays rays(elements, scene, lamps, leaf);
  bool any = false;
  for (std::size_t i = 0; i < points.size() && !any; ++i)
    rays.from(points[i], [&](LightId, const Rgb&, const tracing::Ray& ray) { any = any || stops(ray); });
  return any;
}

}  // namespace deltalux::direct
