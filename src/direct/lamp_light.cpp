#include "direct/lamp_light.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::direct {

const LampLight* askedLight(std::span<const LampLight> lamps, LightId id) {
  const auto at = std::ranges::find_if(lamps, [&](const LampLight& l) { return l.lamp == id && l.points > 0; });
  return at == lamps.end() ? nullptr : &*at;
}

DimmedLight dimmed(std::span<const LampLight> lamps, std::span<const Rgb> dimming) {
  DimmedLight sum;
  double variance = 0;
  for (const LampLight& l : lamps) {
    const Rgb E = l.E * dimming[l.lamp.index()];
    sum.E += E;
    if (!(l.variance > 0)) continue;
    const double factor = double(gray(E)) / std::max(gray(l.E), 1e-30f);
    variance += l.variance * factor * factor;
  }
  sum.deviation = static_cast<float>(std::sqrt(variance));
  return sum;
}

void addDrawn(std::vector<LampLight>& to, std::vector<LampLight> found, int samples, double variance) {
  std::ranges::stable_sort(found, {}, &LampLight::lamp);
  double all = 0;
  for (const LampLight& l : found) all += gray(l.E);
  if (!(all > 0)) return;
  for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
    RgbSum sum(0.0);
    for (end = begin; end < found.size() && found[end].lamp == found[begin].lamp; ++end) sum += RgbSum(found[end].E);
    to.push_back({found[begin].lamp, Rgb(sum / double(samples)), static_cast<float>(variance * gray(sum) / all), 0});
  }
}

}  // namespace deltalux::direct
