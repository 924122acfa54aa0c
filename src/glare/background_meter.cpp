#include "glare/background_meter.hpp"

#include "glare/sight_frame.hpp"
#include "solution/solution.hpp"

namespace deltalux::glare {

namespace {

constexpr int kMostPaths = 1 << 16;  // of an eye [limit]

/// The scene with all lights off but skies.
Scene withoutLuminaires(Scene scene) {
  for (Light& light : scene.lights)
    if (!std::holds_alternative<DomeLight>(light.emitter)) light.scale = Rgb(0.0f), light.standby = false;
  return scene;
}

}  // namespace

BackgroundMeter::BackgroundMeter(const Solution& s, const rendering::Reconstruction& reconstruction)
    : scene_(s.scene),
      paths_(s, reconstruction, {0, 24}),
      meter_(withoutLuminaires(s.scene), s.settings.diffuseOnly, s.tracer, paths_) {}

double BackgroundMeter::lux(const Eye& eye, const GlareSettings& settings, std::uint64_t key) const {
  ProbeSettings probing;
  probing.error = settings.error, probing.maxSamples = kMostPaths;
  const ProbeResult result = meter_.at({eye.position, SightFrame(eye).ahead}, probing, key);
  return photometric(result.irradiance, scene_.luminousEfficacy);
}

}  // namespace deltalux::glare
