#include "render/light_meter.hpp"

#include <algorithm>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "render/caustic_light.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kOnSurface = 1e-3;             // [m] this near, a point lies on a surface [defined]
constexpr float kRoundings = 8;                 // the same, in steps of its coordinates in single precision [rounding]
constexpr double kFacing = 0.5;                 // cosine from which a side faces the normal [defined]
constexpr int kMaxLayers = 16;                  // surfaces that are looked at around a point [limit]
constexpr double kShare = 0.70710678118654752;  // of the error that each of two independent parts may have [defined]

}  // namespace

LightMeter::LightMeter(const Solution& s, const Reconstruction& reconstruction)
    : solution_(s),
      scene_(s.scene),
      tracer_(*s.tracer),
      reconstruction_(reconstruction),
      paths_(s, reconstruction_, {0, 24}),
      lines_(s) {}

ProbeResult LightMeter::measure(const ProbePoint& point, const ProbeSettings& settings, std::uint64_t key) const {
  const auto spot = surfaceAt(point);
  return spot ? onSurface(*spot, settings, key) : space_->at(point, settings, combineKeys(key, 1));
}

const ParticleField& LightMeter::particles() const {
  std::call_once(once_, [&] { particles_ = std::make_unique<const ParticleField>(solution_); });
  return *particles_;
}

void LightMeter::prepare(std::span<const ProbePoint> points) const {
  if (space_) return;
  const bool inSpace = std::any_of(points.begin(), points.end(), [&](const ProbePoint& p) { return !surfaceAt(p); });
  if (inSpace) space_ = std::make_unique<const SpaceMeter>(solution_, paths_);
}

/// How near a surface has to be for a point to lie on it.
double LightMeter::reachAt(const Vec3& p) const {
  const float rounding = std::numeric_limits<float>::epsilon() * tracing::largestCoordinate(Vec3f(p));
  return std::max(kOnSurface / scene_.metresPerUnit, double(kRoundings * rounding));
}

std::optional<SurfaceSpot> LightMeter::surfaceAt(const ProbePoint& point) const {
  const double reach = reachAt(point.position);
  const Vec3f n(point.normal);
  tracing::Ray ray;
  ray.origin = Vec3f(point.position + reach * point.normal);
  ray.direction = -n;
  ray.tFar = static_cast<float>(2 * reach);
  std::optional<SurfaceSpot> best;
  double least = kInfinity;
  for (int layer = 0; layer < kMaxLayers; ++layer) {
    const tracing::Hit hit = tracer_.closestHit(ray);
    if (!hit) break;
    const Vec3 p(hit.position);
    const double away = glm::length(p - point.position);
    const Vec3f side = hit.front ? hit.normal : -hit.normal;
    if (away < least && glm::dot(side, n) > kFacing && !isPane(scene_.materialOf(hit.primitive))) {
      least = away;
      best = SurfaceSpot{hit.primitive, hit.triangle, hit.front, p, Vec3(side)};
    }
    ray.origin = tracing::offsetOrigin(Vec3f(p), hit.normal, ray.direction);
    ray.tFar -= hit.t;
    if (!(ray.tFar > 0)) break;
  }
  return best;
}

ProbeResult LightMeter::onSurface(const SurfaceSpot& spot, const ProbeSettings& settings, std::uint64_t key) const {
  const hierarchy::ElementId side = reconstruction_.locator.side(spot.primitive, spot.triangle, spot.front);
  const direct::Receiver receiver{spot.position, spot.normal};
  if (!side.valid()) {
    if (settings.mesh) return {};
    return directAt(receiver, std::nullopt, Rgb(0.0f), settings.error, settings, key);
  }
  const hierarchy::ElementId leaf = reconstruction_.locator.locate(side, spot.position).leaf;
  const hierarchy::ElementLight& about = solution_.elements.radiometry[leaf.index()];
  ProbeResult result;
  if (settings.mesh) {
    result.irradiance = RgbSum(about.direct + about.indirect + about.particle);
    return result;
  }
  const Rgb particles = particleLight(spot);
  const double share = kShare * settings.error;
  result = lines_.at(Vec3f(spot.position), Vec3f(spot.normal), gray(about.direct + particles), share,
                     static_cast<std::uint64_t>(settings.maxSamples), combineKeys(key, 3));
  const ProbeResult direct =
      directAt(receiver, leaf, Rgb(result.irradiance) + particles, share, settings, combineKeys(key, 4));
  result.irradiance += direct.irradiance + RgbSum(particles);
  result.standardError =
      glm::sqrt(result.standardError * result.standardError + direct.standardError * direct.standardError);
  result.samples += direct.samples;
  return result;
}

ProbeResult LightMeter::directAt(const direct::Receiver& x, std::optional<hierarchy::ElementId> leaf,
                                 const Rgb& ambient, double error, const ProbeSettings& settings,
                                 std::uint64_t key) const {
  const PointSources& sources = reconstruction_.sources;
  return direct::measure(sources.light(), leaf ? sources.at(*leaf, x) : sources.light().sources(x), x,
                         leaf ? sources.lightAt(*leaf) : gray(ambient), ambient, error, settings.maxSamples, key);
}

Rgb LightMeter::particleLight(const SurfaceSpot& spot) const {
  const auto caustic =
      causticLight(solution_.caustics, scene_, spot.primitive, spot.triangle, spot.front, spot.position);
  return caustic ? *caustic : particles().at(spot.primitive, spot.front, spot.position, spot.normal);
}

std::vector<ProbeResult> measureAll(const LightMeter& meter, std::span<const ProbePoint> points,
                                    const ProbeSettings& settings, Progress* progress) {
  std::vector<ProbeResult> results(points.size());
  meter.prepare(points);
  WorkProgress work(progress, "probe", points.size());
  parallelFor(points.size(), 1, [&](std::size_t i) {
    work.begin();
    results[i] = meter.measure(points[i], settings, combineKeys(settings.seed, i));
    work.done();
  });
  return results;
}

}  // namespace deltalux::rendering
