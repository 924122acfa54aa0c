#include "radiosity/direct_light.hpp"

#include <algorithm>

#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::radiosity {

namespace {

constexpr int kBatch = 64,
              kFirstBatches = 4;              // shadow rays of one independent estimate; estimates before any judgement
constexpr TestRays kFreeTests{256, 64, 512};  // from a free point, which sees skies as a whole

}  // namespace

DirectLight::DirectLight(const Scene& scene, const hierarchy::Elements& elements, const hierarchy::Links& links,
                         const tracing::RayTracer& tracer)
    : scene_(scene), elements_(elements), tracer_(tracer), lights_(scene), senders_(elements, links, scene) {}

/// A sender and what test rays say of it.
struct DirectLight::Trial {
  PossibleSender sender;
  int tests = 0, hits = 0;
  bool promising = false;  // seen, or next to a part of the sky that is seen

  /// That a ray passes, by the test rays and, a little, by the link's own from all over its receiver.
  float chance() const {
    const float known = std::min(4.0f, static_cast<float>(sender.rays));
    return (static_cast<float>(hits) + sender.open * known + 0.5f) / (static_cast<float>(tests) + known + 1.0f);
  }
};

template <class ReceiverAt>
void DirectLight::test(Trial& trial, int tests, std::uint64_t key, const ReceiverAt& receiver) const {
  const std::uint64_t own = combineKeys(key, elements_.key[trial.sender.sender.index()]);
  for (; trial.tests < tests; ++trial.tests) {
    const auto i = static_cast<std::uint32_t>(trial.tests);
    const UnitPair u = scrambledSobol(i, own);
    const auto a = arrival(trial.sender.sender, receiver(i, own), {u.x, u.y});
    if (a && !isBlack(a->E)) ++trial.hits;
  }
}

/// Cells of the sky that touch one that was seen: a window shows some of each.
void DirectLight::promoteNeighbours(std::vector<Trial>& trials) const {
  for (Trial& t : trials) {
    t.promising = t.hits > 0 || (t.sender.rays > 0 && t.sender.open > 0);
    if (t.promising || !elements_.isDistant(t.sender.sender)) continue;
    const hierarchy::ElementGeometry& g = elements_.shape(t.sender.sender);
    for (const Trial& other : trials) {
      if (other.hits == 0 || !elements_.isDistant(other.sender.sender)) continue;
      const hierarchy::ElementGeometry& o = elements_.shape(other.sender.sender);
      if (glm::dot(g.center, o.center) > std::cos(std::min(1.1f * (g.radius + o.radius), float(kPi))))
        t.promising = true;
    }
  }
}

template <class ReceiverAt>
SenderChoice DirectLight::tested(const std::vector<PossibleSender>& senders, const TestRays& tests, std::uint64_t key,
                                 const ReceiverAt& receiver) const {
  float total = 0;
  for (const PossibleSender& s : senders) total += s.potential;
  std::vector<Trial> trials;
  for (const PossibleSender& s : senders) {
    trials.push_back({s});
    test(trials.back(), std::clamp(static_cast<int>(tests.all * s.potential / total), tests.fewest, tests.most), key,
         receiver);
  }
  promoteNeighbours(trials);
  SenderChoice choice;
  for (Trial& t : trials) {
    if (!t.promising) continue;
    test(t, tests.most, key, receiver);
    // Rays in proportion to the standard deviation of one, which is that of its visibility.
    choice.seen.add(t.sender.sender, t.sender.potential * std::sqrt(t.chance()));
  }
  // The sun could outshine all else, but was looked for longest: it must not take every ray meant for the unseen.
  const float limit = choice.seen.total() > 0 ? choice.seen.total() : std::numeric_limits<float>::infinity();
  for (const Trial& t : trials)
    if (!t.promising) choice.unseen.add(t.sender.sender, std::min(t.sender.potential * t.chance(), limit));
  return choice;
}

SenderChoice DirectLight::choiceAt(hierarchy::ElementId leaf, const TestRays& tests) const {
  return tested(senders_.at(leaf), tests, elements_.key[leaf.index()], [&](std::uint32_t i, std::uint64_t key) {
    const UnitPair u = scrambledSobol(i, combineKeys(key, 1));
    const hierarchy::PatchPoint p = hierarchy::samplePatch(elements_, scene_, leaf, u.x, u.y);
    return Receiver{Vec3(p.position), Vec3(p.normal)};
  });
}

SenderChoice DirectLight::choiceAt(const Receiver& x) const {
  return tested(senders_.at(Vec3f(x.position), Vec3f(x.normal)), kFreeTests, 0,
                [&](std::uint32_t, std::uint64_t) { return x; });
}

int DirectLight::raysToUnseen(const SenderChoice& choice, int rays) {
  if (!(choice.unseen.total() > 0)) return 0;
  return choice.seen.total() > 0 ? std::max(1, rays / 4) : rays;
}

std::optional<LightArrival> DirectLight::shadowRay(const SenderList& choice, const Receiver& x, int k, int rays,
                                                   std::uint32_t index, std::uint64_t key) const {
  const float total = choice.total();
  if (!(total > 0)) return std::nullopt;
  const double shift = scrambledSobol(index, combineKeys(key, 1)).x;
  const float target = static_cast<float>((k + shift) / rays) * total;
  const auto it = std::upper_bound(choice.cumulative.begin(), choice.cumulative.end() - 1, target);
  const auto chosen = static_cast<std::size_t>(it - choice.cumulative.begin());
  const float share = *it - (chosen > 0 ? choice.cumulative[chosen - 1] : 0.0f);
  const UnitPair u =
      scrambledSobol(index * static_cast<std::uint32_t>(rays) + static_cast<std::uint32_t>(k), combineKeys(key, 2));
  auto result = arrival(choice.senders[chosen], x, {u.x, u.y});
  if (result) result->E *= total / (share * static_cast<float>(rays));
  return result;
}

std::optional<LightArrival> DirectLight::arrival(hierarchy::ElementId sender, const Receiver& x, const Vec2& u) const {
  const auto sample = sampleSender(sender, x, u);
  if (!sample || !(glm::dot(sample->direction, x.normal) > 0)) return std::nullopt;
  const Rgb V = tracer_.transmittance(
      deltalux::tracing::shadowRay(x.position, x.normal, sample->direction, sample->distance, sample->normal));
  if (isBlack(V)) return std::nullopt;
  return LightArrival{sample->direction, elements_.light[sample->sender.index()], V * sample->E};
}

std::optional<DirectLight::SenderSample> DirectLight::sampleSender(hierarchy::ElementId e, const Receiver& x,
                                                                   Vec2 u) const {
  float chance = 1;
  if (elements_.isCluster(e)) e = pickLight(e, Vec3f(x.position), u.x, chance);
  if (!e.valid()) return std::nullopt;
  const bool mesh =
      elements_.isPatch(e) && std::holds_alternative<Mesh>(scene_[elements_.domain[e.index()].primitive].shape);
  std::optional<SenderSample> result;
  if (elements_.at(e).depth == 0 && !mesh) {
    const auto s = lights_.sample(elements_.light[e.index()], x.position, u);
    if (!s) return std::nullopt;
    result = SenderSample{e, s->direction, s->distance, s->normal,
                          s->pdf > 0 ? s->radiance * float(1.0 / s->pdf) : s->radiance};
    if (!ownSide(e, x.position + s->distance * s->direction, s->normal)) return std::nullopt;
  } else {
    result = samplePart(e, x, u);
  }
  if (result) result->E *= 1.0f / chance;
  return result;
}

/// An emitter that shines from both sides has an element for each, and each speaks for its own side.
bool DirectLight::ownSide(hierarchy::ElementId e, const Vec3& y, const Vec3& normal) const {
  if (!elements_.isPatch(e)) return true;
  const Primitive& primitive = scene_[elements_.domain[e.index()].primitive];
  if (!scene_[primitive.material].emission->bothSides) return true;
  const Vec3 front = pointAt(primitive.shape, parameterAt(primitive.shape, y)).normal;
  return (glm::dot(front, normal) > 0) == elements_.at(e).front;
}

std::optional<DirectLight::SenderSample> DirectLight::samplePart(hierarchy::ElementId e, const Receiver& x,
                                                                 const Vec2& u) const {
  const hierarchy::ElementGeometry& g = elements_.shape(e);
  const LightId light = elements_.light[e.index()];
  if (elements_.isDistant(e)) {
    const Vec3 w(hierarchy::directionOf(elements_, scene_, e, u.x, u.y));
    return SenderSample{e, w, kInfinity, Vec3(0.0), g.area * lights_.radianceFrom(light, w)};
  }
  const hierarchy::PatchPoint y = hierarchy::samplePatch(elements_, scene_, e, u.x, u.y);
  const Vec3 d = Vec3(y.position) - x.position;
  const double squared = glm::dot(d, d);
  if (!(squared > 0)) return std::nullopt;
  const double distance = std::sqrt(squared);
  const Vec3 w = d / distance;
  const double cosine = -glm::dot(w, Vec3(y.normal));
  if (!(cosine > 0)) return std::nullopt;
  const Rgb L = lights_.emittedRadiance(light, -w, distance, elements_.at(e).front);
  return SenderSample{e, w, distance, Vec3(y.normal), static_cast<float>(g.area * cosine / squared) * L};
}

hierarchy::ElementId DirectLight::pickLight(hierarchy::ElementId e, const Vec3f& x, double& u, float& chance) const {
  // What a child sends this way; a little is credited to all, so that none is impossible.
  const auto strength = [&](hierarchy::ElementId c) {
    const hierarchy::ElementGeometry& g = elements_.shape(c);
    const Vec3f d = x - g.center;
    const float squared = std::max(glm::dot(d, d), 1e-20f);
    const float near = squared + g.radius * g.radius;
    if (elements_.isCluster(c)) {
      const hierarchy::DirectionalRgb& I = elements_.cluster(c).intensity;
      return (gray(I.at(d / std::sqrt(squared))) + 0.1f * gray(glm::max(I.c[0], Rgb(0.0f)))) / near;
    }
    const float B = gray(elements_.radiometry[c.index()].B);
    if (elements_.isPoint(c)) return B / near;
    const float cosine = elements_.at(c).flat ? glm::dot(g.normal, d) / std::sqrt(squared) : 1.0f;
    return B * g.area * std::max(cosine, 0.05f) / near;
  };
  while (elements_.isCluster(e)) {
    float sum = 0;
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) sum += strength(elements_.child(e, i));
    if (!(sum > 0)) return {};
    double rest = u * sum;
    hierarchy::ElementId picked;
    float part = 0;
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) {
      const float s = strength(elements_.child(e, i));
      if (s <= 0) continue;
      picked = elements_.child(e, i), part = s;
      if (rest < s) break;
      rest -= s;
    }
    u = std::clamp(rest / part, 0.0, 0x1.fffffffffffffp-1);
    chance *= part / sum;
    e = picked;
  }
  return e;
}

Rgb DirectLight::irradiance(const SenderChoice& choice, const Receiver& x, int rays, std::uint32_t index,
                            std::uint64_t key) const {
  Rgb sum(0.0f);
  sample(choice, x, rays, index, key,
         [&](const LightArrival& a) { sum += static_cast<float>(glm::dot(a.direction, x.normal)) * a.E; });
  return sum;
}

ProbeResult DirectLight::measure(const SenderChoice& choice, const Receiver& x, const Rgb& ambient, double error,
                                 int maxSamples, std::uint64_t key) const {
  ProbeResult result;
  if (choice.dark()) return result;
  RgbSum sum(0.0), squares(0.0);
  int batches = 0;
  while (batches < kFirstBatches || result.samples + kBatch <= static_cast<std::uint64_t>(maxSamples)) {
    const RgbSum E(irradiance(choice, x, kBatch, 0, combineKeys(key, batches)));
    sum += E, squares += E * E;
    ++batches;
    result.samples += kBatch;
    const double n = batches;
    result.irradiance = sum / n;
    const RgbSum variance = glm::max(squares / n - result.irradiance * result.irradiance, RgbSum(0.0));
    result.standardError = glm::sqrt(variance / std::max(n - 1, 1.0));
    if (batches >= kFirstBatches &&
        gray(result.standardError) <= error * (gray(result.irradiance) + gray(RgbSum(ambient))))
      break;
  }
  return result;
}

}  // namespace deltalux::radiosity
