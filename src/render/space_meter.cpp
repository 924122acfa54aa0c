#include "render/space_meter.hpp"

#include "base/batch_mean.hpp"
#include "base/pilot_paths.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

SpaceMeter::SpaceMeter(const Solution& s, const EyePaths& paths)
    : SpaceMeter(s.scene, s.settings.diffuseOnly, s.tracer, paths) {}

SpaceMeter::SpaceMeter(const Scene& scene, bool diffuseOnly, std::shared_ptr<const tracing::RayTracer> rays,
                       const EyePaths& paths)
    : scene_(scene, diffuseOnly, std::move(rays)),
      connections_(scene_),
      table_(scene_, connections_, kPilotPaths),
      tracer_(scene_, connections_, table_, 0, [&paths](const tracing::Hit& hit) { return paths.diffuse(hit); }) {}

ProbeResult SpaceMeter::at(const ProbePoint& x, const ProbeSettings& settings, std::uint64_t key) const {
  ProbeResult result;
  BatchMean mean;
  std::uint64_t rays = 0;
  while (mean.count() < deltalux::tuning::kFewestEstimates ||
         result.samples < static_cast<std::uint64_t>(settings.maxSamples)) {
    RgbSum own(0.0);
    for (std::uint32_t i = 0; i < direct::kEstimateRays; ++i) {
      PathSampler sampler(combineKeys(key, static_cast<std::uint64_t>(mean.count())), i);
      own += tracer_.irradiance(x.position, x.normal, sampler, rays);
    }
    mean.add(own / double(direct::kEstimateRays));
    result.samples += direct::kEstimateRays;
    if (mean.count() >= deltalux::tuning::kFewestEstimates &&
        gray(mean.standardError()) <= settings.error * gray(mean.mean()))
      break;
  }
  result.irradiance = mean.mean(), result.standardError = mean.standardError();
  return result;
}

}  // namespace deltalux::rendering
