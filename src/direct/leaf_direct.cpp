#include "direct/leaf_direct.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "direct/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::direct {

namespace {

constexpr int kMostPoints = 64;
constexpr std::uint64_t kLampKey = 0x6c616d70735f5full, kDrawKey = 0x647261775f5f5full;
static_assert(tuning::kUnshadowedPoints <= kMostPoints && tuning::kSunPilots + tuning::kMixedSunRays <= kMostPoints);

/// In inverse proportion to the error: the area where rays disagree shrinks with the mesh as well.
int raysFor(double error, int normal) {
  return std::clamp(static_cast<int>(std::lround(normal * tuning::kBaseError / error)), tuning::kFaintRays,
                    kMostPoints - tuning::kSunPilots);
}

}  // namespace

/// The open points of a patch in order, each made when it is first asked for.
struct DirectSampler::Points {
  Points(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId patch, const KnownPoints& k)
      : sequence(elements, scene, patch), known(k) {}

  /// Makes the next open point; false where there is none.
  bool next() {
    while (drawn < 2 * kMostPoints && count < kMostPoints) {
      const std::uint32_t i = drawn++;
      if (i < known.known && i < 64 && (known.covered >> i & 1)) continue;
      const UnitPair place = sequence.place(i);
      at[count] = sequence.pointAt(place);
      quadrant[count] = static_cast<std::uint8_t>((place.x < 0.5 ? 0 : 1) + (place.y < 0.5 ? 0 : 2));
      number[count++] = i;
      return true;
    }
    return false;
  }
  bool have(int wanted) {
    while (count < wanted)
      if (!next()) return false;
    return true;
  }

  hierarchy::LeafSequence sequence;
  KnownPoints known;
  std::array<hierarchy::PatchPoint, kMostPoints> at;
  std::array<std::uint8_t, kMostPoints> quadrant;
  std::array<std::uint32_t, kMostPoints> number;
  int count = 0;
  std::uint32_t drawn = 0;
};

/// What shadow rays to one lamp have found.
struct DirectSampler::Tally {
  int first = 0;  // point
  int samples = 0, shot = 0, passed = 0;
  RgbSum open{0.0}, lit{0.0};  // sums of unshadowed and of found light
  std::array<double, 4> quadrants{}, counts{};
  double squares = 0;
  std::uint32_t rays = 0;
  Rgb unshadowed{0.0f};  // mean of what would be found without shadows, where it is
  bool measured = false;

  bool mixed() const { return passed > 0 && passed < samples; }
};

DirectSampler::DirectSampler(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                             const Lamps& lamps, double error)
    : elements_(elements),
      scene_(scene),
      tracer_(tracer),
      lamps_(lamps),
      lampRays_(raysFor(error, tuning::kLampRays)),
      mixedRays_(raysFor(error, tuning::kMixedRays)),
      mixedSunRays_(std::max(tuning::kSunRays, raysFor(error, tuning::kMixedSunRays))) {}

namespace {

/// Whether a lamp is so near that its light varies much over the patch.
bool nearBy(const Lamp& lamp, const hierarchy::ElementGeometry& g) {
  const Vec3f center = 0.5f * (lamp.lower + lamp.upper), half = 0.5f * (lamp.upper - lamp.lower);
  return glm::length(center - g.center) < tuning::kNearBy * (g.radius + glm::length(half));
}

/// What a light would bring to a point without shadows, by a sample that shines there [W/m2].
struct OpenLight {
  Rgb E{0.0f};
  std::optional<scene::LightSample> sample;

  tracing::Ray ray(const hierarchy::PatchPoint& x) const {
    return tracing::shadowRay(Vec3(x.position), Vec3(x.normal), sample->direction, sample->distance, sample->normal);
  }
};

OpenLight openLight(const scene::LightSampler& sampler, LightId id, const hierarchy::PatchPoint& x, const UnitPair& u) {
  OpenLight light{Rgb(0.0f), sampler.sample(id, Vec3(x.position), {u.x, u.y})};
  if (!light.sample) return light;
  const double cosine = glm::dot(light.sample->direction, Vec3(x.normal)), pdf = light.sample->pdf;
  if (cosine > 0) light.E = light.sample->radiance * static_cast<float>(cosine / (pdf > 0 ? pdf : 1.0));
  return light;
}

}  // namespace

void DirectSampler::shoot(const Lamp& lamp, Points& points, int upTo, Tally& t) const {
  const ScrambledSobol numbers(combineKeys(combineKeys(points.sequence.key(), kLampKey), lamp.id.value));
  for (; t.samples < upTo && points.have(t.first + t.samples + 1); ++t.samples) {
    const auto k = static_cast<std::size_t>(t.first + t.samples);
    const hierarchy::PatchPoint& x = points.at[k];
    t.counts[points.quadrant[k]] += 1;
    const OpenLight light = openLight(lamps_.sampler(), lamp.id, x, numbers(points.number[k]));
    const Rgb open = light.E;
    if (isBlack(open)) continue;
    const Rgb lit = open * tracer_.transmittance(light.ray(x));
    ++t.shot, ++t.rays, t.passed += !isBlack(lit);
    t.open += RgbSum(open), t.lit += RgbSum(lit);
    t.quadrants[points.quadrant[k]] += gray(lit), t.squares += double(gray(lit)) * gray(lit);
  }
}

Rgb DirectSampler::unshadowed(const Lamp& lamp, Points& points, int wanted) const {
  const ScrambledSobol numbers(combineKeys(combineKeys(points.sequence.key(), kLampKey), lamp.id.value));
  RgbSum sum(0.0);
  points.have(wanted);
  const int n = std::min(points.count, wanted);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (const auto E = lamps_.sampler().irradiance(lamp.id, Vec3(points.at[k].position), Vec3(points.at[k].normal))) {
      sum += RgbSum(*E);
      continue;
    }
    sum += RgbSum(openLight(lamps_.sampler(), lamp.id, points.at[k], numbers(points.number[k])).E);
  }
  return n > 0 ? Rgb(sum / double(n)) : Rgb(0.0f);
}

LeafDirect DirectSampler::at(hierarchy::ElementId patch, const KnownPoints& known, const Splits& splits) const {
  LeafDirect result;
  const hierarchy::ElementGeometry& g = elements_.shape(patch);
  Points points(elements_, scene_, patch, known);
  struct Asked {
    const Lamp* lamp;
    double potential, weight;  // weight: one over the chance of being drawn
  };
  std::vector<Asked> asked;
  double rest = 0;
  for (const Lamp& lamp : lamps_.all()) {
    const double potential = lamps_.potential(lamp, g);
    if (!(potential > 0)) continue;
    asked.push_back({&lamp, potential, 1});
    result.tooWideForBeam = result.tooWideForBeam || g.radius > tuning::kBeam * lamps_.beamWidth(lamp, g);
  }
  if (asked.empty() || !points.have(1)) return result;
  if (asked.size() > tuning::kLampsAsked + tuning::kLampsDrawn) {
    // The many that may bring little stand for each other, drawn in proportion to what that is.
    std::stable_sort(asked.begin(), asked.end(),
                     [](const Asked& a, const Asked& b) { return a.potential > b.potential; });
    std::vector<Asked> drawn(asked.begin(), asked.begin() + tuning::kLampsAsked);
    for (std::size_t i = tuning::kLampsAsked; i < asked.size(); ++i) rest += asked[i].potential;
    const double offset = toUnit(combineKeys(points.sequence.key(), kDrawKey));
    double before = 0;
    int taken = 0;
    for (std::size_t i = tuning::kLampsAsked; i < asked.size(); ++i) {
      before += asked[i].potential * tuning::kLampsDrawn / rest;
      int times = 0;
      while (taken < tuning::kLampsDrawn && taken + offset < before) ++taken, ++times;
      if (times > 0)
        drawn.push_back({asked[i].lamp, asked[i].potential, times * rest / (tuning::kLampsDrawn * asked[i].potential)});
    }
    asked = std::move(drawn);
  }

  // Pilot samples decide how many others are worth taking, and take no part in the estimate: where few rays pass, what
  // is refined because one did would be worth less than it counts, and the rest nothing.
  std::vector<Tally> pilots(asked.size());
  double found = 0;
  for (std::size_t l = 0; l < asked.size(); ++l) {
    const Lamp& lamp = *asked[l].lamp;
    Tally& t = pilots[l];
    shoot(lamp, points, lamp.sun ? tuning::kSunPilots : tuning::kLampPilots, t);
    if (t.samples > 0) found += asked[l].weight * gray(t.lit) / t.samples;
    result.rays += t.rays;
  }
  std::vector<Tally> tallies(asked.size());
  std::array<double, 4> quadrants{};
  double variance = 0;
  for (std::size_t l = 0; l < asked.size(); ++l) {
    const Lamp& lamp = *asked[l].lamp;
    const Tally& pilot = pilots[l];
    const double weight = asked[l].weight;
    const double open = pilot.shot > 0 ? gray(pilot.open) / pilot.samples : asked[l].potential;
    int wanted = lamp.sun ? (pilot.mixed() ? mixedSunRays_ : tuning::kSunRays) : pilot.mixed() ? mixedRays_ : lampRays_;
    if (!lamp.sun && !(weight * open > tuning::kMatters * found)) wanted = tuning::kFaintRays;
    Tally& t = tallies[l];
    t.first = pilot.samples;
    shoot(lamp, points, wanted, t);
    if (t.samples == 0) t = pilot;  // there are no more points
    if (!lamp.sun && t.shot == 0) {
      // Of a narrow beam few points may lie in it: shadow rays start from some that do.
      t.unshadowed = unshadowed(lamp, points, kMostPoints), t.measured = true;
      for (int more = wanted; t.shot == 0 && !isBlack(t.unshadowed) && t.samples == more && more < kMostPoints;)
        shoot(lamp, points, more = std::min(2 * more, kMostPoints), t);
    }
    result.rays += t.rays;
    if (t.passed == 0) continue;
    result.E += static_cast<float>(weight / t.samples) * Rgb(t.lit);
    const double mean = gray(t.lit) / t.samples;
    if (t.samples > 1 && t.mixed())
      variance += weight * weight * std::max(0.0, t.squares / t.samples - mean * mean) / (t.samples - 1);
    for (std::size_t q = 0; q < 4; ++q)
      quadrants[q] += weight * (t.counts[q] > 0 ? t.quadrants[q] / t.counts[q] : mean);
  }
  const double mean = 0.25 * (quadrants[0] + quadrants[1] + quadrants[2] + quadrants[3]);
  double between = 0;
  for (const double q : quadrants) between += (q - mean) * (q - mean) / 3;
  result.variation = static_cast<float>(std::sqrt(between));
  result.deviation = static_cast<float>(std::sqrt(variance));
  if (splits && splits(result)) return result;

  const double light = gray(result.E);
  result.E = Rgb(0.0f);
  for (std::size_t l = 0; l < asked.size(); ++l) {
    const Lamp& lamp = *asked[l].lamp;
    Tally& t = tallies[l];
    if (t.passed == 0) continue;
    Rgb E(t.lit / double(t.samples));
    if (!lamp.sun) {
      const bool much = asked[l].weight * gray(t.lit) > tuning::kMuch * light * t.samples;
      const bool varied = t.shot < t.samples || nearBy(lamp, g);
      if (!t.measured)
        t.unshadowed = unshadowed(lamp, points, much && varied ? kMostPoints : tuning::kUnshadowedPoints);
      for (int c = 0; c < 3; ++c)
        E[c] = t.open[c] > 0 ? t.unshadowed[c] * static_cast<float>(t.lit[c] / t.open[c]) : 0.0f;
    }
    result.E += static_cast<float>(asked[l].weight) * E;
  }
  return result;
}

bool variesTooMuch(const LeafDirect& direct, const hierarchy::ElementGeometry& g, double meanDistance, double level,
                   double error) {
  const double side = tuning::kScale * meanDistance, around = side * side;
  if (g.area < tuning::kFinest * error * around) return false;
  return direct.variation * g.area > tuning::kVariation * error * level * std::max<double>(around, g.area);
}

}  // namespace deltalux::direct
