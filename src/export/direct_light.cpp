#include "export/direct_light.hpp"

#include <algorithm>

#include "scene/nominal_scale.hpp"
#include "solution/solution.hpp"

namespace deltalux::exporting {

namespace {

/// Of a solution that was not solved by light, as it is now.
bool holdsSky(const Solution& s, const LightGroup& group) {
  return std::ranges::any_of(group.lights, [&](LightId id) {
    const Light& light = s.scene[id];
    return std::holds_alternative<DomeLight>(light.emitter) && (!s.columns.empty() || !isBlack(light.scale));
  });
}

/// By light: what lightOf() sets them to.
std::vector<Rgb> scalesOfGroup(const Solution& s, const LightGroup& group, std::size_t number) {
  std::vector<Rgb> scales(s.scene.lights.size(), Rgb(0.0f));
  for (std::size_t i = 0; i < group.lights.size(); ++i)
    scales[group.lights[i].index()] =
        s.columns.empty() ? s.scene[group.lights[i]].scale : s.columns.of[number].scales[i];
  return scales;
}

}  // namespace

DirectLight::DirectLight(const SolutionView& view) {
  const Solution& s = view.get();
  const std::vector<LightGroup> groups = lightGroups(view);
  for (std::size_t g = 0; g < groups.size(); ++g)
    meters_.push_back(holdsSky(s, groups[g]) ? nullptr
                                             : std::make_unique<const direct::LampMeter>(
                                                   s.scene, *s.tracer, scalesOfGroup(s, groups[g], g)));
}

DirectLight DirectLight::together(const SolutionView& view) {
  const Scene& scene = view.get().scene;
  DirectLight light;
  light.meters_.push_back(std::make_unique<const direct::LampMeter>(scene, *view.get().tracer, scene::scalesOf(scene)));
  return light;
}

bool DirectLight::any() const {
  return std::ranges::any_of(meters_, [](const auto& meter) { return meter != nullptr; });
}

}  // namespace deltalux::exporting
