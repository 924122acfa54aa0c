#include "scene/nominal_scale.hpp"

#include <cmath>

#include "scene/tuning.hpp"

namespace deltalux::scene {

namespace {

/// Whether it counts for less when it is dimmed.
bool fades(const Light& light) {
  if (light.standby) return false;
  return std::holds_alternative<SunLight>(light.emitter) || std::holds_alternative<DomeLight>(light.emitter);
}

float nominalScale(const Light& light) {
  const float scale = maxChannel(light.scale);
  if (!(scale > 0)) return fades(light) ? 0.0f : 1.0f;
  const int step = static_cast<int>(std::ceil(std::log2(scale) / tuning::kNominalOctaves));
  return std::ldexp(1.0f, tuning::kNominalOctaves * (fades(light) ? step : std::max(step, 0)));
}

}  // namespace

std::vector<Rgb> nominalScales(const Scene& scene) {
  std::vector<Rgb> scales;
  for (const Light& light : scene.lights) scales.emplace_back(nominalScale(light));
  return scales;
}

std::vector<Rgb> scalesOf(const Scene& scene) {
  std::vector<Rgb> scales;
  for (const Light& light : scene.lights) scales.push_back(light.scale);
  return scales;
}

std::vector<Rgb> dimming(const Scene& scene) {
  std::vector<Rgb> factors;
  for (const Light& light : scene.lights) {
    const float nominal = nominalScale(light);
    factors.push_back(nominal > 0 ? light.scale / nominal : Rgb(0.0f));
  }
  return factors;
}

}  // namespace deltalux::scene
