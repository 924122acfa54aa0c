// Where light at a point comes from: what a light meter measures there (light_meter.hpp), kept apart by who sends it.
#include <deltalux/contributions.hpp>

#include <algorithm>
#include <deltalux/solution_reader.hpp>
#include <map>

#include "base/check.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"
#include "render/particle_paths.hpp"
#include "render/reader_state.hpp"

namespace deltalux {

namespace {

/// The strongest first, and no more than so many.
template <class T>
void keepStrongest(std::vector<T>& list, std::size_t most) {
  std::stable_sort(list.begin(), list.end(), [](const T& a, const T& b) { return gray(a.E) > gray(b.E); });
  if (list.size() > most) list.resize(most);
}

/// Shadow rays until the sum over all lamps is known well enough; each goes to the account of the lamp that it met.
/// `sample(key, visit)` shoots those of one independent estimate.
template <class Sample>
void measureLamps(const Sample& sample, const Vec3& normal, const ContributionSettings& settings,
                  Contributions& result) {
  std::map<LightId, RgbSum> lamps;
  RgbSum sum(0.0), squares(0.0);
  double n = 0;
  for (int estimate = 0;
       estimate < deltalux::tuning::kFewestEstimates || (estimate + 1) * direct::kEstimateRays <= settings.maxSamples;
       ++estimate) {
    RgbSum E(0.0);
    sample(combineKeys(settings.seed, static_cast<std::uint64_t>(estimate)), [&](const auto& a) {
      const RgbSum one(static_cast<float>(glm::dot(a.direction, normal)) * a.E);
      E += one, lamps[a.light] += one;
    });
    sum += E, squares += E * E, ++n;
    const RgbSum mean = sum / n, variance = glm::max(squares / n - mean * mean, RgbSum(0.0));
    if (n >= deltalux::tuning::kFewestEstimates && gray(glm::sqrt(variance / (n - 1))) <= settings.error * gray(mean))
      break;
  }
  result.direct = sum / n;
  for (const auto& [light, E] : lamps)
    if (gray(E) > 0) result.lamps.push_back({light, E / n});
}

/// The same at a point of a leaf, or of a surface without one.
void measureAt(const rendering::PointSources& points, std::optional<hierarchy::ElementId> leaf,
               const direct::Receiver& x, const ContributionSettings& settings, Contributions& result) {
  const std::vector<direct::Source> sources = leaf ? points.at(*leaf, x) : points.light().sources(x);
  direct::Aim aim(sources);
  aim.learn(points.light(), {&x, 1}, direct::kLearnAtPoint, combineKeys(settings.seed, 1));
  aim = aim.at(sources, leaf ? points.lightAt(*leaf) : 0.0f, direct::kEstimateRays);
  if (aim.dark()) return;
  measureLamps([&](std::uint64_t key, const auto& visit) { aim.sample(points.light(), x, 0, key, visit); }, x.normal,
               settings, result);
}

/// Last reflections, by the objects that they are on.
void gatherSurfaces(const Solution& s, const rendering::LineGather& lines, const direct::Receiver& x,
                    const ContributionSettings& settings, Contributions& result) {
  struct Sent {
    RgbSum E{0.0};
    Vec3 centre{0};
  };
  std::map<ObjectId, Sent> objects;
  const auto add = [&](hierarchy::ElementId sender, const Rgb& share) {
    const PrimitiveId primitive = s.elements.domain[sender.index()].primitive;
    Sent& sent = objects[primitive.valid() ? s.scene[primitive].object : ObjectId()];
    const RgbSum E(share);
    sent.E += E, sent.centre += gray(E) * Vec3(s.elements.shape(sender).center);
    result.indirect += E;
  };
  // The relative error of the sum of n alike is one over the root.
  const auto least = static_cast<double>(deltalux::tuning::kFewestEstimates * direct::kEstimateRays);
  const auto count = static_cast<std::uint32_t>(
      std::clamp(1 / (settings.error * settings.error), least, std::max(least, double(settings.maxSamples))));
  lines.forEachLine(Vec3f(x.position), Vec3f(x.normal), count, settings.seed, add);
  for (const auto& [object, sent] : objects)
    if (gray(sent.E) > 0) result.surfaces.push_back({object, sent.centre / gray(sent.E), sent.E});
}

}  // namespace

Contributions SolutionReader::contributions(const ProbePoint& point, const ContributionSettings& settings) const {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the error is a fraction between 0 and 1");
  const Solution& s = state_->solution();
  const rendering::Reconstruction& reconstruction = *state_->reconstruction;
  const rendering::LightMeter& meter = state_->lightMeter();
  Contributions result;
  const auto spot = meter.surfaceAt(point);
  if (!spot) return result;
  result.onSurface = true;
  const direct::Receiver x{spot->position, spot->normal};
  const hierarchy::ElementId side = reconstruction.locator.side(spot->primitive, spot->triangle, spot->front);
  if (side.valid()) {
    const hierarchy::ElementId leaf = reconstruction.locator.locate(side, spot->position).leaf;
    measureAt(reconstruction.sources, leaf, x, settings, result);
    gatherSurfaces(s, meter.lines(), x, settings, result);
    const Rgb particle = meter.particleLight(*spot);
    result.particle = RgbSum(particle);
    if (!isBlack(particle)) result.paths = rendering::particlePathsAt(s, *spot, particle);
  } else {
    measureAt(reconstruction.sources, std::nullopt, x, settings, result);
  }
  keepStrongest(result.lamps, settings.most);
  keepStrongest(result.surfaces, settings.most);
  keepStrongest(result.paths, settings.most);
  return result;
}

}  // namespace deltalux
