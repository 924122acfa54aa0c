#include "export/page_lights.hpp"

#include <algorithm>

namespace deltalux::exporting {

namespace {

using LightKind = PageGroup::Kind;

LightKind kindOf(const Light& light) {
  if (std::holds_alternative<SunLight>(light.emitter)) return LightKind::Sun;
  return std::holds_alternative<DomeLight>(light.emitter) ? LightKind::Sky : LightKind::Lamp;
}

/// About what a light sends, at scale 1: flux of lamps [W], of suns and skies irradiance [W/m2].
struct Sent {
  const Scene& scene;

  Rgb operator()(const AreaLight& l) const {
    const auto& emission = scene.materialOf(l.primitive).emission;
    return emission ? static_cast<float>(kPi * area(scene[l.primitive].shape)) * emission->radiance : Rgb(0.0f);
  }
  Rgb operator()(const PointLight& l) const { return static_cast<float>(4 * kPi) * l.intensity; }
  Rgb operator()(const SpotLight& l) const { return static_cast<float>(2 * kPi * (1 - l.cosOuter)) * l.intensity; }
  Rgb operator()(const LambertPointLight& l) const { return static_cast<float>(kPi) * l.intensity; }
  Rgb operator()(const PhotometricLight& l) const { return l.scale; }
  Rgb operator()(const SunLight& l) const { return static_cast<float>(solidAngle(l)) * l.radiance; }
  /// Radiance halfway up, towards the four quarters.
  Rgb operator()(const DomeLight& l) const {
    const Vec3 side = glm::normalize(glm::cross(l.up, std::abs(l.up.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 other = glm::cross(l.up, side);
    Rgb sum(0.0f);
    for (const Vec3& towards : {side, other, -side, -other}) sum += skyRadiance(l, glm::normalize(l.up + towards));
    return isBlack(sum) ? l.scale : sum;
  }
};

bool isSwitchedOff(const Scene& scene, LightId light) {
  return std::ranges::any_of(scene.switchedOff, [&](const SwitchedOff& off) { return off.light == light; });
}

}  // namespace

std::vector<PageGroup> pageGroups(const Scene& scene, const std::vector<LightGroup>& groups, bool present) {
  std::vector<PageGroup> out;
  for (const LightGroup& group : groups) {
    PageGroup page{group.name, LightKind::Lamp, Rgb(1.0f), Rgb(0.0f), {}};
    for (const LightId id : group.lights) {
      const Light& light = scene[id];
      page.colour += (present ? light.scale : Rgb(1.0f)) * std::visit(Sent{scene}, light.emitter);
      if (std::ranges::find(page.lights, light.name, &PageLight::name) == page.lights.end())
        page.lights.push_back({light.name, present ? light.scale : Rgb(1.0f), isSwitchedOff(scene, id)});
    }
    if (!group.lights.empty()) {
      const LightKind first = kindOf(scene[group.lights.front()]);
      const bool same = std::ranges::all_of(group.lights, [&](LightId l) { return kindOf(scene[l]) == first; });
      page.kind = same ? first : LightKind::Lamp;
      if (!present) page.weight = scene[group.lights.front()].scale;
    }
    page.colour = maxChannel(page.colour) > 0 ? page.colour / maxChannel(page.colour) : Rgb(1.0f);
    out.push_back(std::move(page));
  }
  return out;
}

}  // namespace deltalux::exporting
