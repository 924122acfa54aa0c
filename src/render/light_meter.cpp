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

constexpr double kOnSurface = 1e-3;  // [m] this near, a point lies on a surface
constexpr float kRoundings = 8;      // the same, in steps of its coordinates in single precision
constexpr double kFacing = 0.5;      // cosine from which a side faces the normal
constexpr int kMaxLayers = 16;       // surfaces that are looked at around a point
constexpr double kGatherRays = 40;   // over the links of a surface point, times the error that is asked for
constexpr int kFewestGatherRays = 1024, kMostGatherRays = 1 << 14;
constexpr int kGatherBatch = 256;  // rays of one independent estimate in free space
constexpr int kFirstBatches = 4;
constexpr double kDirectShare =
    0.7;  // of the error that direct light may have; gathered light the same: 0.7^2 + 0.7^2 = 1

}  // namespace

int gatherRays(double error) {
  return std::clamp(static_cast<int>(kGatherRays / error), kFewestGatherRays, kMostGatherRays);
}

LightMeter::LightMeter(const Solution& s, const Reconstruction& reconstruction)
    : solution_(s),
      scene_(s.scene),
      elements_(s.elements),
      caustics_(s.caustics),
      tracer_(*s.tracer),
      reconstruction_(reconstruction),
      paths_(s, reconstruction_, {0, 24}),
      sampler_(s.scene, s.elements, s.links, *s.tracer) {
  if (s.settings.method == SolveMethod::Lines) lines_ = std::make_unique<const LineGather>(s);
}

ProbeResult LightMeter::measure(const ProbePoint& point, const ProbeSettings& settings, std::uint64_t key) const {
  const auto spot = surfaceAt(point);
  return spot ? onSurface(*spot, settings, key) : inFreeSpace(point, settings, key);
}

const ParticleField& LightMeter::particles() const {
  std::call_once(once_, [&] { particles_ = std::make_unique<const ParticleField>(solution_); });
  return *particles_;
}

void LightMeter::prepare(std::span<const ProbePoint> points) const {
  if (!lines_ || space_) return;
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
  const radiosity::Receiver receiver{spot.position, spot.normal};
  if (!side.valid()) {
    if (settings.mesh) return {};
    if (lines_) return directAt(receiver, std::nullopt, Rgb(0.0f), settings.error, settings, key);
    return reconstruction_.direct.measure(reconstruction_.direct.choiceAt(receiver), receiver, Rgb(0.0f),
                                          settings.error, settings.maxSamples, key);
  }
  const hierarchy::LeafPoint at = reconstruction_.locator.locate(side, spot.position);
  if (settings.mesh) {
    const hierarchy::ElementLight& l = elements_.radiometry[at.leaf.index()];
    ProbeResult result;
    result.irradiance = RgbSum(l.direct + l.indirect + l.particle);
    return result;
  }
  if (lines_) return overLines(at, spot, settings, key);
  const Rgb indirect = indirectAt(at, spot, settings.error);
  ProbeResult result = reconstruction_.direct.measure(reconstruction_.choices.at(at.leaf), receiver, indirect,
                                                      settings.error, settings.maxSamples, key);
  result.irradiance += RgbSum(indirect);
  return result;
}

ProbeResult LightMeter::overLines(const hierarchy::LeafPoint& at, const SurfaceSpot& spot,
                                  const ProbeSettings& settings, std::uint64_t key) const {
  const radiosity::Receiver receiver{spot.position, spot.normal};
  const Rgb particles = particleLight(spot);
  const hierarchy::ElementLight& about = elements_.radiometry[at.leaf.index()];
  const double share = kDirectShare * settings.error;
  ProbeResult result = lines_->at(Vec3f(spot.position), Vec3f(spot.normal), gray(about.direct + particles), share,
                                  static_cast<std::uint64_t>(settings.maxSamples), combineKeys(key, 3));
  const ProbeResult direct =
      directAt(receiver, at.leaf, Rgb(result.irradiance) + particles, share, settings, combineKeys(key, 4));
  result.irradiance += direct.irradiance + RgbSum(particles);
  result.standardError =
      glm::sqrt(result.standardError * result.standardError + direct.standardError * direct.standardError);
  result.samples += direct.samples;
  return result;
}

ProbeResult LightMeter::directAt(const radiosity::Receiver& x, std::optional<hierarchy::ElementId> leaf,
                                 const Rgb& ambient, double error, const ProbeSettings& settings,
                                 std::uint64_t key) const {
  const PointSources& points = *reconstruction_.points;
  const direct::Receiver receiver{x.position, x.normal};
  const std::vector<direct::Source> sources = leaf ? points.at(*leaf, receiver) : points.light().sources(receiver);
  return direct::measure(points.light(), sources, receiver, leaf ? points.lightAt(*leaf) : gray(ambient), ambient,
                         error, settings.maxSamples, key);
}

Rgb LightMeter::indirectAt(const hierarchy::LeafPoint& at, const SurfaceSpot& spot, double error) const {
  return sampler_.atPoint(at.leaf, Vec3f(spot.position), Vec3f(spot.normal), gatherRays(error)) + particleLight(spot);
}

Rgb LightMeter::particleLight(const SurfaceSpot& spot) const {
  const auto caustic = causticLight(caustics_, scene_, spot.primitive, spot.triangle, spot.front, spot.position);
  return caustic ? *caustic : particles().at(spot.primitive, spot.front, spot.position, spot.normal);
}

ProbeResult LightMeter::inFreeSpace(const ProbePoint& point, const ProbeSettings& settings, std::uint64_t key) const {
  if (lines_) return space_->at(point, settings, combineKeys(key, 1));
  const radiosity::Receiver receiver{point.position, point.normal};
  const ProbeResult gathered = gather(receiver, settings, combineKeys(key, 1));
  ProbeResult result =
      reconstruction_.direct.measure(reconstruction_.direct.choiceAt(receiver), receiver, Rgb(gathered.irradiance),
                                     kDirectShare * settings.error, settings.maxSamples, combineKeys(key, 2));
  result.irradiance += gathered.irradiance;
  result.standardError =
      glm::sqrt(result.standardError * result.standardError + gathered.standardError * gathered.standardError);
  result.samples += gathered.samples;
  return result;
}

/// Light from surfaces: cosine-distributed rays read what they see.
ProbeResult LightMeter::gather(const radiosity::Receiver& x, const ProbeSettings& settings, std::uint64_t key) const {
  ProbeResult result;
  const Frame frame(x.normal);
  RgbSum sum(0.0), squares(0.0);
  Sights sights(elements_, reconstruction_);
  int batches = 0;
  while (batches < kFirstBatches || result.samples + kGatherBatch <= static_cast<std::uint64_t>(settings.maxSamples)) {
    RgbSum batch(0.0);
    const std::uint64_t own = combineKeys(key, batches);
    for (std::uint32_t i = 0; i < kGatherBatch; ++i) {
      const UnitPair u = scrambledSobol(i, own);
      EyeRay eye;
      eye.ray.origin = Vec3f(x.position);
      eye.ray.direction = Vec3f(cosineDirection(frame, u.x, u.y));
      eye.emitters = false;  // lights in plain view are measured apart
      eye.key = own, eye.index = i;
      batch += RgbSum(paths_.radiance(eye, sights));
    }
    batch *= kPi / kGatherBatch;
    sum += batch, squares += batch * batch;
    ++batches;
    result.samples += kGatherBatch;
    const double n = batches;
    result.irradiance = sum / n;
    result.standardError =
        glm::sqrt(glm::max(squares / n - result.irradiance * result.irradiance, RgbSum(0.0)) / std::max(n - 1, 1.0));
    if (batches >= kFirstBatches &&
        gray(result.standardError) <= kDirectShare * settings.error * gray(result.irradiance))
      break;
  }
  return result;
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
