// Luminaires of a scene by kind: those of one measured distribution, or of one name and flux.
#include <algorithm>
#include <cmath>
#include <deltalux/sheet.hpp>
#include <map>

#include "glare/luminaires.hpp"

namespace deltalux {

namespace {

/// Flux of a point-like light by a sum over directions [W].
template <class Emitter>
double fluxOfPoint(const Emitter& light) {
  constexpr int kRings = 180, kAround = 72;  // [defined]
  double sum = 0;
  for (int r = 0; r < kRings; ++r) {
    const double z = -1 + 2 * (r + 0.5) / kRings, s = std::sqrt(1 - z * z);
    for (int a = 0; a < kAround; ++a) {
      const double phi = 2 * kPi * (a + 0.5) / kAround;
      sum += gray(radiantIntensity(light, Vec3(s * std::cos(phi), s * std::sin(phi), z)));
    }
  }
  return 4 * kPi * sum / (kRings * kAround);
}

/// In W, of lights in scenes of such a unit; the light's scale is not in it.
double fluxOf(const Scene& scene, const AreaLight& light) {
  const auto& emission = scene.materialOf(light.primitive).emission;
  if (!emission) return 0;
  // Exitance is pi L, but a spot's: its rays stay within a cone, of projected solid angle pi sin^2.
  double solid = kPi;
  if (emission->spot) solid *= std::pow(std::sin(std::min(emission->spot->fullAngle / 2, kPi / 2)), 2);
  const double sides = emission->bothSides ? 2 : 1;
  return sides * solid * gray(emission->radiance) * area(scene[light.primitive].shape);
}
double fluxOf(const Scene&, const PhotometricLight& light) {
  return luminousFlux(*light.photometry) / kLuminousEfficacy * gray(light.scale);
}
double fluxOf(const Scene&, const PointLight& light) { return 4 * kPi * gray(light.intensity); }
double fluxOf(const Scene&, const SpotLight& light) { return fluxOfPoint(light); }
double fluxOf(const Scene&, const LambertPointLight& light) { return kPi * gray(light.intensity); }
double fluxOf(const Scene&, const SunLight&) { return 0; }
double fluxOf(const Scene&, const DomeLight&) { return 0; }

/// "panel-12" and "panel.3" are of the kind "panel", "wheel.3.lamp" is of the kind "wheel.lamp".
std::string kindOf(const std::string& name) {
  std::string kind;
  for (std::size_t from = 0; from <= name.size();) {
    const std::size_t dot = std::min(name.find('.', from), name.size());
    const std::string part = name.substr(from, dot - from);
    if (part.find_first_not_of("0123456789") != std::string::npos) kind += (kind.empty() ? "" : ".") + part;
    from = dot + 1;
  }
  const std::size_t end = kind.find_last_not_of("0123456789-_");
  return end == std::string::npos ? name : kind.substr(0, end + 1);
}

bool sameLight(const std::shared_ptr<const Photometry>& a, const std::shared_ptr<const Photometry>& b) {
  if (a == b) return true;
  return a && b && a->candela == b->candela && a->verticals == b->verticals && a->horizontals == b->horizontals;
}

}  // namespace

std::vector<LuminaireType> luminaireTypes(const Scene& scene, const std::vector<LuminairePower>& known) {
  const double lumens = scene.luminousEfficacy * scene.metresPerUnit * scene.metresPerUnit;
  std::vector<LuminaireType> types;
  for (const glare::LuminaireLights& luminaire : glare::luminairesOf(scene)) {
    LuminaireType type{kindOf(luminaire.name), 1, 0, {}, {}};
    for (const LightId id : luminaire.lights) {
      const Light& light = scene[id];
      type.flux +=
          lumens * gray(light.scale) * std::visit([&](const auto& e) { return fluxOf(scene, e); }, light.emitter);
      if (const auto* measured = std::get_if<PhotometricLight>(&light.emitter)) type.photometry = measured->photometry;
    }
    if (!(type.flux > 0)) continue;
    for (const LuminairePower& power : known) {
      const std::vector<LightId> lights = lightsMatching(scene, power.pattern);
      if (std::ranges::find(lights, luminaire.lights.front()) == lights.end()) continue;
      if (!power.name.empty()) type.name = power.name;
      type.watts = power.watts;
      break;
    }
    const auto same = std::ranges::find_if(types, [&](const LuminaireType& t) {
      constexpr double kSame = 1e-3;  // of flux [rounding]
      return t.name == type.name && t.watts == type.watts && sameLight(t.photometry, type.photometry) &&
             std::abs(t.flux - type.flux) <= kSame * t.flux;
    });
    if (same == types.end())
      types.push_back(std::move(type));
    else
      ++same->count;
  }
  std::ranges::stable_sort(types, std::greater(), [](const LuminaireType& t) { return t.count * t.flux; });
  return types;
}

}  // namespace deltalux
