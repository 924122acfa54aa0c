#include "direct/lamp_meter.hpp"

#include <algorithm>
#include <cmath>

#include "direct/open_light.hpp"
#include "direct/point_light.hpp"
#include "direct/tuning.hpp"

namespace deltalux::direct {

namespace {

constexpr std::uint64_t kMeterKey = 0x6c616d706d657472ull;  // [key]
constexpr double kMostLampRays = 4096;                      // of a lamp at a point [limit]

/// So many that a shadow's edge across a lamp is told to `allowed` of what it may bring: stratified points in a shape
/// with an edge are off by half n^(-3/4).
int raysToTell(double potential, double allowed) {
  return static_cast<int>(std::ceil(std::clamp(std::pow(0.5 * potential / allowed, 4.0 / 3), 1.0, kMostLampRays)));
}

}  // namespace

LampMeter::LampMeter(const Scene& scene, const tracing::RayTracer& tracer, const std::vector<Rgb>& scales)
    : lamps_(scene, scales), tracer_(tracer) {}

Rgb LampMeter::of(const Reaching& reaching, const hierarchy::PatchPoint& x, double allowed, Doubt doubt) const {
  const LightId id = reaching.lamp->id;
  const scene::LightSampler& sampler = lamps_.sampler();
  const bool point = sampler.isPointLike(id);
  const auto known = point ? std::optional<Rgb>() : sampler.irradiance(id, Vec3(x.position), Vec3(x.normal));
  if (known && isBlack(*known)) return Rgb(0.0f);
  const double potential = known ? double(gray(*known)) : reaching.potential;
  const int most = point ? 1 : raysToTell(potential, allowed);
  const int asked = static_cast<int>(std::ceil(std::sqrt(most)));
  const int pilots = doubt == Doubt::Much ? asked : std::min(asked, tuning::kLampPilots);
  const ScrambledSobol numbers(combineKeys(kMeterKey, id.value));
  RgbSum open(0.0), lit(0.0);
  double least = kInfinity, greatest = 0;  // of what passes
  int taken = 0;
  for (int end : {pilots, most}) {
    for (; taken < end; ++taken) {
      const OpenLight light = openLight(sampler, id, x, numbers(static_cast<std::uint32_t>(taken)));
      if (isBlack(light.E)) continue;
      const Rgb passed = tracer_.transmittance(light.ray(x));
      open += RgbSum(light.E), lit += RgbSum(light.E * passed);
      least = std::min(least, double(gray(passed))), greatest = std::max(greatest, double(gray(passed)));
    }
    if (!((greatest - least) * potential > allowed)) break;
  }
  if (!known) {
    // More of them without rays: the light that is there, and not its shadow, is what varies.
    const RgbSum shadowed = lit;
    RgbSum all = open;
    for (int k = taken; k < most; ++k) all += RgbSum(openLight(sampler, id, x, numbers(std::uint32_t(k))).E);
    Rgb out(0.0f);
    for (int c = 0; c < 3; ++c)
      if (open[c] > 0) out[c] = static_cast<float>(shadowed[c] / open[c] * all[c] / std::max(most, taken));
    return out;
  }
  Rgb out(0.0f);
  for (int c = 0; c < 3; ++c)
    if (open[c] > 0) out[c] = static_cast<float>(lit[c] / open[c]) * (*known)[c];
  return out;
}

std::vector<LampMeter::Reaching> LampMeter::reaching(const Vec3& position, const Vec3& normal) const {
  const hierarchy::ElementGeometry patch = pointPatch({position, normal});
  std::vector<Reaching> found;
  const auto add = [&](std::uint32_t i, double potential) {
    if (potential > 0) found.push_back({&lamps_.all()[i], potential});
  };
  for (const std::uint32_t i : lamps_.suns()) add(i, potential(lamps_.all()[i], patch));
  lamps_.tree().reaching(patch, add);
  return found;
}

LampMeter::Reading LampMeter::read(const Vec3& position, const Vec3& normal, float ambient, double error,
                                   Doubt doubt) const {
  const std::vector<Reaching> all = reaching(position, normal);
  Reading out;
  for (const Reaching& r : all) out.open += r.potential;
  // In a penumbra about half of it is there.
  const double allowed = error * (double(ambient) + 0.5 * out.open);
  for (const Reaching& r : all) out.E += of(r, {Vec3f(position), Vec3f(normal)}, allowed, doubt);
  return out;
}

}  // namespace deltalux::direct
