#include "render/space_meter.hpp"

#include "base/random.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kTableBudget = 1e6;   // test samples behind the choice of connections
constexpr std::uint32_t kBatch = 256;  // paths of one independent estimate
constexpr int kFewestBatches = 8;      // before any judgement

}  // namespace

SpaceMeter::SpaceMeter(const Solution& s, const EyePaths& paths)
    : scene_(s.scene, s.settings.diffuseOnly, s.tracer),
      connections_(scene_),
      table_(scene_, connections_, kTableBudget),
      tracer_(scene_, connections_, table_, 0,
              [&paths](const tracing::Hit& hit, const Vec3& direction) { return paths.diffuse(hit, direction); }) {}

ProbeResult SpaceMeter::at(const ProbePoint& x, const ProbeSettings& settings, std::uint64_t key) const {
  ProbeResult result;
  RgbSum sum(0.0), squares(0.0);
  std::uint64_t rays = 0;
  for (int batch = 0; batch < kFewestBatches || result.samples < static_cast<std::uint64_t>(settings.maxSamples);
       ++batch) {
    RgbSum own(0.0);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      PathSampler sampler(combineKeys(key, static_cast<std::uint64_t>(batch)), i);
      own += tracer_.irradiance(x.position, x.normal, sampler, rays);
    }
    own /= double(kBatch);
    sum += own, squares += own * own;
    result.samples += kBatch;
    const double n = batch + 1;
    result.irradiance = sum / n;
    result.standardError =
        glm::sqrt(glm::max(squares / n - result.irradiance * result.irradiance, RgbSum(0.0)) / std::max(n - 1, 1.0));
    if (batch + 1 >= kFewestBatches && gray(result.standardError) <= settings.error * gray(result.irradiance)) break;
  }
  return result;
}

}  // namespace deltalux::rendering
