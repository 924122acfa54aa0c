#include "engine/light_columns.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/check_interrupted.hpp"
#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "hierarchy/pull.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kColumnLeaves = 4096;  // of a task [task]

/// Scales of a group's lights in its column.
std::vector<Rgb> columnScales(const Scene& scene, const LightGroup& group) {
  const auto scale = [&](LightId light) { return scene[light].scale; };
  const bool alike =
      std::ranges::all_of(group.lights, [&](LightId light) { return scale(light) == scale(group.lights.front()); });
  std::vector<Rgb> scales;
  for (const LightId light : group.lights) scales.push_back(alike ? Rgb(1.0f) : scale(light));
  return scales;
}

/// What a column's lights send of what samples took them for, by its scales of all lights.
Dimming dimmingOf(const LightParts& parts, const Scene& scene, const std::vector<Rgb>& scales) {
  Dimming dimming{std::vector<Rgb>(scales.size(), Rgb(0.0f)), Rgb(0.0f)};
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (isBlack(parts.nominal[i]) || isBlack(scales[i])) continue;
    dimming.lights[i] = scales[i] / parts.nominal[i];
    // Skies that are not dimmed alike were taken for what they are, and so they are in their column.
    if (std::holds_alternative<DomeLight>(scene.lights[i].emitter))
      dimming.skies = parts.skies.dimmedAlike() ? dimming.lights[i] : Rgb(1.0f);
  }
  return dimming;
}

LightColumn columnOf(Solution& s, const LightParts& parts, const LightGroup& group) {
  LightColumn column;
  column.scales = columnScales(s.scene, group);
  std::vector<Rgb> scales(s.scene.lights.size(), Rgb(0.0f));
  for (std::size_t i = 0; i < group.lights.size(); ++i) scales[group.lights[i].index()] = column.scales[i];
  parts.transfer.apply(s.elements, scales);
  const std::size_t n = parts.leaves.size();
  parallelFor(n, kColumnLeaves,
              [&](std::size_t i) { s.elements.radiometry[parts.leaves[i].index()].indirect = Rgb(0.0f); });
  relight(s, parts.leaves, parts.exchange, parts.lamps, parts.sky, dimmingOf(parts, s.scene, scales),
          deltalux::tuning::kConverged);
  hierarchy::pull(s.elements);
  column.direct.resize(n), column.indirect.resize(n), column.particle.resize(n), column.deviation = s.deviation;
  parallelFor(n, kColumnLeaves, [&](std::size_t i) {
    const hierarchy::ElementLight& l = s.elements.radiometry[parts.leaves[i].index()];
    column.direct[i] = l.direct, column.indirect[i] = l.indirect, column.particle[i] = l.particle;
  });
  if (s.settings.causticTextures && s.particles.impacts() > 0)
    column.caustics = caustics::makeCaustics(
        s.scene, s.elements, particles::impacts(s.particles, s.elements, s.scene, scales), s.settings.error);
  return column;
}

}  // namespace

void keepLightsApart(Solution& s, const LightParts& parts, Progress* progress) {
  s.columns = {groupsOf(s.scene, s.settings.groups), {}};
  for (const LightGroup& group : s.columns.groups) {
    checkInterrupted(progress);
    s.columns.of.push_back(columnOf(s, parts, group));
    const std::size_t done = s.columns.of.size(), all = s.columns.groups.size();
    if (progress) progress->report("light by light", static_cast<double>(done) / static_cast<double>(all));
  }
  addUp(s, weightsOf(s.columns, s.scene).value());
  DELTALUX_VALIDATED(validate(s.columns, s.scene, parts.leaves.size()));
}

}  // namespace deltalux::engine
