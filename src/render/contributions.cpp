// Where light at a point comes from: what a light meter measures there (light_meter.hpp), kept apart by who sends it.
#include <deltalux/contributions.hpp>

#include <algorithm>
#include <deltalux/solution_reader.hpp>
#include <map>

#include "base/check.hpp"
#include "base/random.hpp"
#include "render/particle_paths.hpp"
#include "render/reader_state.hpp"

namespace deltalux {

namespace {

constexpr int kShadowRays = 64;     // of one independent estimate
constexpr int kFirstEstimates = 4;  // before any judgement

/// The strongest first, and no more than so many.
template <class T>
void keepStrongest(std::vector<T>& list, std::size_t most) {
  std::stable_sort(list.begin(), list.end(), [](const T& a, const T& b) { return gray(a.E) > gray(b.E); });
  if (list.size() > most) list.resize(most);
}

/// Shadow rays until the sum over all lamps is known well enough; each goes to the account of the lamp that it met.
void measureLamps(const radiosity::DirectLight& direct, const radiosity::SenderChoice& choice,
                  const radiosity::Receiver& x, const ContributionSettings& settings, Contributions& result) {
  if (choice.dark()) return;
  std::map<LightId, RgbSum> lamps;
  RgbSum sum(0.0), squares(0.0);
  double n = 0;
  for (int estimate = 0; estimate < kFirstEstimates || (estimate + 1) * kShadowRays <= settings.maxSamples;
       ++estimate) {
    RgbSum E(0.0);
    direct.sample(choice, x, kShadowRays, 0, combineKeys(settings.seed, estimate),
                  [&](const radiosity::LightArrival& a) {
                    const RgbSum one(static_cast<float>(glm::dot(a.direction, x.normal)) * a.E);
                    E += one, lamps[a.light] += one;
                  });
    sum += E, squares += E * E, ++n;
    const RgbSum mean = sum / n, variance = glm::max(squares / n - mean * mean, RgbSum(0.0));
    if (n >= kFirstEstimates && gray(glm::sqrt(variance / (n - 1))) <= settings.error * gray(mean)) break;
  }
  result.direct = sum / n;
  for (const auto& [light, E] : lamps)
    if (gray(E) > 0) result.lamps.push_back({light, E / n});
}

/// Last reflections, by the objects that they are on.
void gatherSurfaces(const Solution& s, hierarchy::ElementId leaf, const radiosity::Receiver& x, double error,
                    Contributions& result) {
  struct Sent {
    RgbSum E{0.0};
    Vec3 centre{0};
  };
  std::map<ObjectId, Sent> objects;
  const radiosity::IndirectSampler sampler(s.scene, s.elements, s.links, *s.tracer);
  for (const auto& share :
       sampler.sharesAtPoint(leaf, Vec3f(x.position), Vec3f(x.normal), rendering::gatherRays(error))) {
    const PrimitiveId primitive = s.elements.domain[share.sender.index()].primitive;
    Sent& sent = objects[primitive.valid() ? s.scene[primitive].object : ObjectId()];
    const RgbSum E(share.E);
    sent.E += E, sent.centre += gray(E) * Vec3(s.elements.shape(share.sender).center);
    result.indirect += E;
  }
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
  const radiosity::Receiver x{spot->position, spot->normal};
  const hierarchy::ElementId side = reconstruction.locator.side(spot->primitive, spot->triangle, spot->front);
  if (side.valid()) {
    const hierarchy::ElementId leaf = reconstruction.locator.locate(side, spot->position).leaf;
    measureLamps(reconstruction.direct, reconstruction.choices.at(leaf), x, settings, result);
    gatherSurfaces(s, leaf, x, settings.error, result);
    const Rgb particle = meter.particleLight(*spot);
    result.particle = RgbSum(particle);
    if (!isBlack(particle)) result.paths = rendering::particlePathsAt(s, *spot, particle);
  } else {
    measureLamps(reconstruction.direct, reconstruction.direct.choiceAt(x), x, settings, result);
  }
  keepStrongest(result.lamps, settings.most);
  keepStrongest(result.surfaces, settings.most);
  keepStrongest(result.paths, settings.most);
  return result;
}

}  // namespace deltalux
