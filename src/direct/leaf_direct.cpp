#include "direct/leaf_direct.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "base/usual_error.hpp"
#include "direct/open_light.hpp"
#include "direct/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::direct {

namespace {

constexpr int kMostPoints = 64;                                                          // [layout]
constexpr std::uint64_t kLampKey = 0x6c616d70735f5full, kDrawKey = 0x647261775f5f5full;  // [key]
/// Shadow rays of a leaf at the usual error: to the sun, to a lamp where rays disagree, to those that are drawn; and
/// points that the unshadowed light of a lamp is averaged over.
constexpr int kRays = deltalux::tuning::kPilots;
/// Rays to the sun that tell whether others disagree: where they do, all that a patch has points for.
constexpr int kSunPilots = kRays / 2;  // [defined]
static_assert(kRays <= kMostPoints);
/// Share of what all lamps may bring above which one is asked on its own: as much as each ray stands for of the most
/// that are drawn for the rest.
constexpr double kAskedShare = 1.0 / deltalux::tuning::kFewestEstimates;  // [defined]

/// In inverse proportion to the error: the area where rays disagree shrinks with the mesh as well.
int raysFor(double error, int normal) {
  return std::clamp(static_cast<int>(std::lround(normal * kUsualError / error)), 1, kMostPoints - kSunPilots);
}

}  // namespace

/// The open points of a patch in order, each made when it is first asked for.
struct DirectSampler::Points {
  Points(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId patch, const KnownPoints& k,
         const KnownShadows* shadows = nullptr)
      : sequence(elements, scene, patch), known(k), before(shadows) {}

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

  /// By which a place on a lamp is chosen.
  ScrambledSobol numbersOf(LightId lamp) const {
    return ScrambledSobol(combineKeys(combineKeys(sequence.key(), kLampKey), lamp.value));
  }

  hierarchy::LeafSequence sequence;
  KnownPoints known;
  const KnownShadows* before;
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
  Rgb light() const { return samples > 0 ? Rgb(lit / double(samples)) : Rgb(0.0f); }
  double mean() const { return samples > 0 ? gray(lit) / samples : 0.0; }
  /// Of the mean, gray.
  double variance() const {
    return samples > 1 ? std::max(0.0, squares / samples - mean() * mean()) / (samples - 1) : 0.0;
  }
  void addQuadrants(std::array<double, 4>& sums) const {
    for (std::size_t q = 0; q < 4; ++q) sums[q] += counts[q] > 0 ? quadrants[q] / counts[q] : mean();
  }
  /// What a ray of `open` has found from a point in quadrant `q`.
  void add(const Rgb& open_, const Rgb& found, std::size_t q) {
    ++shot, passed += !isBlack(found);
    open += RgbSum(open_), lit += RgbSum(found);
    quadrants[q] += gray(found), squares += double(gray(found)) * gray(found);
  }
};

/// A lamp that has rays of its own.
struct DirectSampler::Asked {
  const Lamp* lamp;
  double potential;
  bool missed;  // by the patch above
  Tally pilot, tally;
  LampShadows shadows;

  std::uint32_t points() const { return static_cast<std::uint32_t>(tally.first + tally.samples); }
  LampLight light() const { return {lamp->id, Rgb(0.0f), 0, points(), shadows}; }
  /// What it would bring, where no ray has seen it.
  double unseen() const {
    return pilot.passed + tally.passed > 0 ? 0.0 : gray(pilot.open + tally.open) / (pilot.samples + tally.samples);
  }
};

/// Lamps that are drawn, and those that turned out to be worth asking.
struct DirectSampler::Drawn {
  const hierarchy::ElementGeometry& patch;
  LampTree::Cut cut;
  struct Passed {
    LampTree::Reaching lamp;
    Rgb lit;  // over its chance
  };
  std::vector<Passed> passed;       // rays that did, those of the pilot first
  std::size_t piloted = 0;          // of these
  std::vector<std::uint32_t> left;  // that are asked on their own instead, ascending
  bool matter = false;
  Tally pilot, tally;

  std::uint32_t points() const { return static_cast<std::uint32_t>(tally.first + tally.samples); }
  /// Moves a lamp to those asked; false where it is there.
  bool leave(std::uint32_t lamp) {
    const auto at = std::lower_bound(left.begin(), left.end(), lamp);
    if (at != left.end() && *at == lamp) return false;
    left.insert(at, lamp);
    return true;
  }
};

DirectSampler::DirectSampler(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                             const Lamps& lamps, double error)
    : elements_(elements),
      scene_(scene),
      tracer_(tracer),
      lamps_(lamps),
      lampRays_(raysFor(error, deltalux::tuning::kFewRays)),
      mixedRays_(raysFor(error, kRays)),
      mixedSunRays_(std::max(kRays, raysFor(error, kMostPoints - kSunPilots))),
      openDrawn_(raysFor(error, kRays)),
      mixedDrawn_(raysFor(error, deltalux::tuning::kFewestEstimates)) {}

namespace {

/// Standard deviation of four values.
double deviationOf(const std::array<double, 4>& values) {
  const double mean = 0.25 * (values[0] + values[1] + values[2] + values[3]);
  double between = 0;
  for (const double v : values) between += (v - mean) * (v - mean) / 3;
  return std::sqrt(between);
}

/// The numbers by which points choose a lamp, and a place on it.
struct Draws {
  explicit Draws(std::uint64_t pointsKey)
      : key(combineKeys(pointsKey, kDrawKey)), offset(toUnit(key)), numbers(combineKeys(key, 1)) {}
  /// By the golden ratio [Roberts18], which has nothing in common with the places of the points.
  double choice(std::size_t point) const {
    constexpr double kGolden = 0.61803398874989485;  // [defined]
    const double u = offset + kGolden * static_cast<double>(point);
    return u - std::floor(u);
  }

  std::uint64_t key;
  double offset;
  ScrambledSobol numbers;
};

LampTree::Cut cutOf(const LampTree& tree, const hierarchy::ElementGeometry& g, const LampSight& above) {
  LampTree::Cut cut;  // no more of them than can bring such a share each
  tree.cut(g, above.none() ? tuning::kMatters : kAskedShare, deltalux::tuning::kFewestEstimates, above.seen, cut);
  return cut;
}

/// Whether a lamp is so near that its light varies much over the patch.
bool nearBy(const Lamp& lamp, const hierarchy::ElementGeometry& g) {
  const Vec3f center = 0.5f * (lamp.lower + lamp.upper), half = 0.5f * (lamp.upper - lamp.lower);
  return glm::length(center - g.center) < deltalux::tuning::kFar * (g.radius + glm::length(half));
}

}  // namespace

void DirectSampler::shoot(const Lamp& lamp, Points& points, int upTo, LampShadows& shadows, Tally& t) const {
  const ScrambledSobol numbers = points.numbersOf(lamp.id);
  const LampLight* before = points.before ? askedLight(points.before->lamps, lamp.id) : nullptr;
  for (; t.samples < upTo && points.have(t.first + t.samples + 1); ++t.samples) {
    const auto k = static_cast<std::size_t>(t.first + t.samples);
    const hierarchy::PatchPoint& x = points.at[k];
    t.counts[points.quadrant[k]] += 1;
    if (isBelow(lamp, x.position, x.normal)) continue;
    const OpenLight light = openLight(lamps_.sampler(), lamp.id, x, numbers(points.number[k]));
    const Rgb open = light.E;
    if (isBlack(open)) continue;
    const std::uint64_t bit = std::uint64_t(1) << k;
    const tracing::Ray ray = light.ray(x);
    if (before && before->shadows.knows(k) && points.before->holds(lamp, ray)) {
      shadows.clear |= before->shadows.clear & bit, shadows.shut |= before->shadows.shut & bit;
      t.add(open, before->shadows.clear & bit ? open : Rgb(0.0f), points.quadrant[k]);
      continue;
    }
    const Rgb V = tracer_.transmittance(ray);
    ++t.rays;
    if (V == Rgb(1.0f)) shadows.clear |= bit;
    if (isBlack(V)) shadows.shut |= bit;
    t.add(open, open * V, points.quadrant[k]);
  }
}

bool DirectSampler::stands(hierarchy::ElementId patch, const KnownPoints& known, const LampSight& above,
                           const LeafDirect& before, const LampTree& treeBefore, std::span<const char> moved,
                           std::uint64_t& rays) const {
  const hierarchy::ElementGeometry& g = elements_.shape(patch);
  const auto isElsewhere = [&](std::uint32_t lamp) { return moved[lamps_.all()[lamp].id.index()] != 0; };
  if (before.sight.drawnSeen || before.tooWideForBeam != lamps_.tooWideForBeam(g) ||
      std::ranges::any_of(lamps_.suns(), isElsewhere))
    return false;
  Drawn drawn{g, cutOf(lamps_.tree(), g, above), {}, 0, {}, false, {}, {}};
  if (std::ranges::any_of(drawn.cut.lamps, isElsewhere, &LampTree::Reaching::lamp) ||
      !std::ranges::equal(drawn.cut.lamps, cutOf(treeBefore, g, above).lamps))
    return false;
  Points points(elements_, scene_, patch, known);
  if (!points.have(1)) return true;
  double found = before.found;
  std::vector<Asked> none;
  askDrawn(above, found, points, drawn, none);
  if (drawn.matter != before.sight.drawnAsked || drawn.pilot.passed > 0) return false;
  finishDrawn(points, drawn);
  rays += drawn.pilot.rays + drawn.tally.rays;
  return drawn.tally.passed == 0 && drawn.points() == before.drawn;
}

bool DirectSampler::anyRay(hierarchy::ElementId patch, const KnownPoints& known, const LampLight& asked,
                           const StopsAny& any, const Stops& stops) const {
  Points points(elements_, scene_, patch, known);
  const ScrambledSobol numbers = points.numbersOf(asked.lamp);
  for (std::size_t k = 0; k < asked.points && points.have(static_cast<int>(k) + 1); ++k) {
    if (!any(points.at[k].position)) continue;
    const OpenLight light = openLight(lamps_.sampler(), asked.lamp, points.at[k], numbers(points.number[k]));
    if (!isBlack(light.E) && stops(light.ray(points.at[k]))) return true;
  }
  return false;
}

bool DirectSampler::anyDrawnRay(hierarchy::ElementId patch, const KnownPoints& known, const LampSight& above,
                                std::uint32_t count, const Stops& stops) const {
  const hierarchy::ElementGeometry& g = elements_.shape(patch);
  const LampTree::Cut cut = cutOf(lamps_.tree(), g, above);
  Points points(elements_, scene_, patch, known);
  const Draws draws(points.sequence.key());
  for (std::size_t k = 0; k < count && points.have(static_cast<int>(k) + 1); ++k) {
    const auto choice = lamps_.tree().draw(cut, g, draws.choice(k));
    if (!choice) continue;
    const LightId id = lamps_.all()[choice->lamp].id;
    const OpenLight light = openLight(lamps_.sampler(), id, points.at[k], draws.numbers(points.number[k]));
    if (!isBlack(light.E) && stops(light.ray(points.at[k]))) return true;
  }
  return false;
}

/// A lamp a ray, over its chance.
void DirectSampler::shootDrawn(Points& points, int upTo, Drawn& drawn, Tally& t) const {
  const Draws draws(points.sequence.key());
  for (; t.samples < upTo && points.have(t.first + t.samples + 1); ++t.samples) {
    const auto k = static_cast<std::size_t>(t.first + t.samples);
    const hierarchy::PatchPoint& x = points.at[k];
    t.counts[points.quadrant[k]] += 1;
    const auto choice = lamps_.tree().draw(drawn.cut, drawn.patch, draws.choice(k));
    if (!choice || std::binary_search(drawn.left.begin(), drawn.left.end(), choice->lamp)) continue;
    const LightId id = lamps_.all()[choice->lamp].id;
    const OpenLight light = openLight(lamps_.sampler(), id, x, draws.numbers(points.number[k]));
    const Rgb open = light.E / static_cast<float>(choice->chance);
    if (isBlack(open)) continue;
    const Rgb lit = open * tracer_.transmittance(light.ray(x));
    ++t.rays;
    t.add(open, lit, points.quadrant[k]);
    if (!isBlack(lit)) drawn.passed.push_back({{choice->lamp, choice->chance * drawn.cut.restMost}, lit});
  }
}

Rgb DirectSampler::unshadowed(const Lamp& lamp, Points& points, int wanted) const {
  const ScrambledSobol numbers = points.numbersOf(lamp.id);
  RgbSum sum(0.0);
  points.have(wanted);
  const int n = std::min(points.count, wanted);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (const auto E = lamps_.sampler().irradiance(lamp.id, Vec3(points.at[k].position), Vec3(points.at[k].normal))) {
      sum += RgbSum(*E);
      continue;
    }
    if (!isBelow(lamp, points.at[k].position, points.at[k].normal))
      sum += RgbSum(openLight(lamps_.sampler(), lamp.id, points.at[k], numbers(points.number[k])).E);
  }
  return n > 0 ? Rgb(sum / double(n)) : Rgb(0.0f);
}

/// Pilot samples decide how many others are worth taking, and take no part in the estimate: where few rays pass, what
/// is refined because one did would be worth less than it counts, and the rest nothing.
void DirectSampler::ask(const Lamp& lamp, double potential, const LampSight& above, Points& points,
                        std::vector<Asked>& asked) const {
  Asked& a = asked.emplace_back(Asked{&lamp, potential, !lamp.sun && above.missed(lamp.id), {}, {}, {}});
  shoot(lamp, points, lamp.sun ? kSunPilots : a.missed ? 1 : tuning::kLampPilots, a.shadows, a.pilot);
}

/// The samples that count, where about as much light as `found` was found.
void DirectSampler::finish(double found, Points& points, Asked& a) const {
  const Lamp& lamp = *a.lamp;
  const Tally& pilot = a.pilot;
  const double open = pilot.shot > 0 ? gray(pilot.open) / pilot.samples : a.potential;
  const bool mixed = pilot.mixed() || (a.missed && pilot.passed > 0);
  int wanted = lamp.sun ? (mixed ? mixedSunRays_ : kRays) : mixed ? mixedRays_ : lampRays_;
  if (!lamp.sun && !(open > tuning::kMatters * found)) wanted = 1;
  a.missed = a.missed && pilot.passed == 0 && wanted > 1;
  if (a.missed) wanted = 1;
  Tally& t = a.tally;
  t.first = pilot.samples;
  shoot(lamp, points, wanted, a.shadows, t);
  if (t.samples == 0) t = pilot, t.rays = 0;  // there are no more points
  if (lamp.sun || a.missed || t.shot > 0) return;
  // Of a narrow beam few points may lie in it: shadow rays start from some that do.
  t.unshadowed = unshadowed(lamp, points, kMostPoints), t.measured = true;
  for (int more = wanted; t.shot == 0 && !isBlack(t.unshadowed) && t.samples == more && more < kMostPoints;)
    shoot(lamp, points, more = std::min(2 * more, kMostPoints), a.shadows, t);
}

/// A patch is kept most often where its rays have missed a lamp: what has decided must not tell the light too, or what
/// few rays see is lost. Where some have seen it and the patch is kept all the same, it is too little to matter. Rays
/// that were traced.
std::uint32_t DirectSampler::askAgain(double all, Points& points, Asked& a) const {
  const double open = a.unseen();
  if (!(open > 0)) return 0;
  Tally fresh;
  fresh.first = a.tally.first + a.tally.samples;
  shoot(*a.lamp, points,
        a.lamp->sun      ? tuning::kLampPilots
        : 2 * open > all ? 2 * tuning::kLampPilots
                         : 1,
        a.shadows, fresh);
  if (fresh.samples == 0) return 0;  // there are no more points
  fresh.unshadowed = a.tally.unshadowed, fresh.measured = a.tally.measured;
  a.missed = true, a.tally = fresh;
  return fresh.rays;
}

/// The share that passes times what would without shadows.
Rgb DirectSampler::refined(const Asked& a, const hierarchy::ElementGeometry& g, Points& points) const {
  const Tally& t = a.tally;
  Rgb E = t.light();
  if (a.lamp->sun || a.missed) return E;  // a ratio of so few would favour what is seen where it is faint
  const bool varied = t.shot < t.samples || nearBy(*a.lamp, g);
  const Rgb open = t.measured ? t.unshadowed : unshadowed(*a.lamp, points, varied ? kMostPoints : kRays);
  for (int c = 0; c < 3; ++c) E[c] = t.open[c] > 0 ? open[c] * static_cast<float>(t.lit[c] / t.open[c]) : 0.0f;
  return E;
}

/// Pilots to those that are drawn, where they may matter beside what was found. Whoever is seen there and may matter is
/// asked on its own. Adds what they have found.
void DirectSampler::askDrawn(const LampSight& above, double& found, Points& points, Drawn& drawn,
                             std::vector<Asked>& asked) const {
  drawn.matter = drawn.cut.restMost > tuning::kMatters * found;
  if (!drawn.matter) return;
  shootDrawn(points, tuning::kLampPilots, drawn, drawn.pilot);
  found += drawn.pilot.mean();
  drawn.piloted = drawn.passed.size();
  for (const auto& [r, lit] : drawn.passed)
    if (r.potential > tuning::kMatters * found && drawn.leave(r.lamp))
      ask(lamps_.all()[r.lamp], r.potential, above, points, asked);
}

void DirectSampler::finishDrawn(Points& points, Drawn& drawn) const {
  if (!(drawn.cut.restMost > 0)) return;
  const Tally& pilot = drawn.pilot;
  int wanted = 1;  // one for all that may bring next to nothing
  if (drawn.matter && pilot.passed == 0)
    wanted = tuning::kLampPilots;
  else if (drawn.matter)
    wanted = pilot.mixed() ? mixedDrawn_ : openDrawn_;
  // The pilots' points again where there are no more: without what is asked on its own now.
  drawn.tally.first = points.have(pilot.samples + 1) ? pilot.samples : 0;
  shootDrawn(points, wanted, drawn, drawn.tally);
}

LeafDirect DirectSampler::at(hierarchy::ElementId patch, const KnownPoints& known, const LampSight& above,
                             const Splits& splits, const KnownShadows* before) const {
  LeafDirect result;
  const hierarchy::ElementGeometry& g = elements_.shape(patch);
  Points points(elements_, scene_, patch, known, before);
  result.tooWideForBeam = lamps_.tooWideForBeam(g);
  if (!points.have(1)) return result;
  Drawn drawn{g, cutOf(lamps_.tree(), g, above), {}, 0, {}, false, {}, {}};
  std::vector<Asked> asked;
  asked.reserve(lamps_.suns().size() + drawn.cut.lamps.size() + tuning::kLampPilots);
  for (const std::uint32_t i : lamps_.suns())
    if (const double most = potential(lamps_.all()[i], g); most > 0) ask(lamps_.all()[i], most, above, points, asked);
  for (const LampTree::Reaching& r : drawn.cut.lamps) ask(lamps_.all()[r.lamp], r.potential, above, points, asked);
  double found = 0;
  for (const Asked& a : asked) found += a.pilot.mean();
  found = result.found = static_cast<float>(found);  // as stands() will know it
  askDrawn(above, found, points, drawn, asked);
  finishDrawn(points, drawn);

  std::array<double, 4> quadrants{};
  double variance = drawn.tally.variance();
  for (Asked& a : asked) {
    finish(found, points, a);
    const Tally& t = a.tally;
    result.rays += a.pilot.rays + t.rays;
    result.sight.asked |= lampBit(a.lamp->id);
    if (a.pilot.passed > 0 || t.passed > 0) result.sight.seen |= lampBits(a.lamp->id);
    if (t.passed == 0) continue;
    result.E += t.light();
    if (t.mixed()) variance += t.variance();
    t.addQuadrants(quadrants);
  }
  result.rays += drawn.pilot.rays + drawn.tally.rays;
  result.sight.drawnAsked = drawn.matter;
  result.sight.drawnSeen = drawn.pilot.passed > 0 || drawn.tally.passed > 0;
  result.E += drawn.tally.light();
  if (drawn.pilot.passed > 0) drawn.tally.addQuadrants(quadrants);
  result.variation = static_cast<float>(deviationOf(quadrants));
  result.deviation = static_cast<float>(std::sqrt(variance));
  const Choice choice = splits ? splits(result) : Choice::Whole;
  result.drawn = drawn.points();
  if (choice == Choice::Split) {
    for (const Asked& a : asked) result.lamps.push_back(a.light());
    return result;
  }
  if (choice == Choice::Keep) {
    double rest = found;  // and what unseen ones would bring
    for (const Asked& a : asked) rest += a.unseen();
    for (Asked& a : asked) result.rays += askAgain(rest, points, a);
  }

  for (const Asked& a : asked) {
    result.lamps.push_back(a.light());
    if (a.tally.passed == 0) continue;
    LampLight& lamp = result.lamps.back();
    lamp.E = refined(a, g, points);
    if (a.tally.mixed()) lamp.variance = static_cast<float>(a.tally.variance());
  }
  std::vector<LampLight> passed;
  for (const Drawn::Passed& p : std::span(drawn.passed).subspan(drawn.piloted))
    passed.push_back({lamps_.all()[p.lamp.lamp].id, p.lit, 0, 0});
  addDrawn(result.lamps, std::move(passed), drawn.tally.samples, drawn.tally.variance());
  result.lamps.shrink_to_fit();
  RgbSum E(0.0);
  variance = 0;
  for (const LampLight& l : result.lamps) E += RgbSum(l.E), variance += l.variance;
  result.E = Rgb(E), result.deviation = static_cast<float>(std::sqrt(variance));
  return result;
}

DirectSampler::Choice choiceOf(const LeafDirect& direct, const hierarchy::ElementGeometry& g, double meanDistance,
                               double level, double error) {
  using enum DirectSampler::Choice;
  if (direct.tooWideForBeam) return Split;
  const double side = tuning::kScale * meanDistance, around = side * side;
  if (g.area < error * around) return Whole;
  return direct.variation * g.area > tuning::kVariation * error * level * std::max<double>(around, g.area) ? Split
                                                                                                           : Keep;
}

}  // namespace deltalux::direct
