#include "render/reference/light_connections.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "render/reference/bent_way.hpp"
#include "render/reference/curved_mirror.hpp"
#include "render/reference/refracting_ball.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

namespace {

/// Samples of the flux that a plane mirror sends, of which a lit patch must not be overlooked: all over it; and of
/// others.
constexpr int kPlaneSamples = deltalux::tuning::kPilots * deltalux::tuning::kPilots,
              kCurvedSamples = deltalux::tuning::kFewestEstimates;

std::uint64_t chainKey(LightId light, const BendChain& chain) {
  std::uint64_t key = light.value;
  for (int i = 0; i < chain.count; ++i) {
    const Bend& b = chain.bends[i];
    key = combineKeys(key, b.surface.value * 16ull + static_cast<std::uint64_t>(b.kind) * 4ull + b.inner);
  }
  return key;
}

bool sameChain(const BendChain& a, const BendChain& b) {
  return a.count == b.count && std::equal(a.bends.begin(), a.bends.begin() + a.count, b.bends.begin());
}

}  // namespace

int BendChain::curved() const {
  for (int i = 0; i < count; ++i) {
    if (bends[i].kind != Bend::Kind::Plane) return i;
  }
  return -1;
}

LightConnections::LightConnections(const ReferenceScene& scene) : scene_(scene) {
  const Scene& values = scene.scene();
  std::vector<LightId> lamps;
  for (std::size_t i = 0; i < values.lights.size(); ++i) {
    const LightId light(i);
    const bool dark = std::holds_alternative<AreaLight>(values[light].emitter) && scene.lights().area(light) <= 0.0;
    if (dark || isBlack(values[light].scale)) continue;
    add({light, {}, 0});
    if (!std::holds_alternative<DomeLight>(values[light].emitter)) lamps.push_back(light);
  }
  const std::vector<Bend> bends = findBends();
  const auto keep = [&](std::vector<Connection> found, std::size_t count) {
    double all = 0, kept = 0;
    for (const Connection& c : found) all += c.flux;
    std::size_t keeping = 0;
    while (keeping < std::min(found.size(), count) && kept < (1 - double(deltalux::tuning::kNegligible)) * all)
      kept += found[keeping++].flux;
    found.resize(keeping);
    for (const Connection& c : found) add(c);
    return found;
  };
  const auto prepend = [](const Bend& bend, const Connection& c) {
    Connection longer{c.light, {}, 0};
    longer.chain.add(bend);
    for (int i = 0; i < c.chain.count; ++i) longer.chain.add(c.chain.bends[i]);
    return longer;
  };
  std::vector<Connection> candidates;
  for (const Bend& bend : bends) {
    for (LightId light : lamps) candidates.push_back(prepend(bend, {light, {}, 0}));
  }
  std::vector<Connection> singles = keep(withFlux(candidates, 0), tuning::kMostSingle);
  const auto most = static_cast<std::size_t>(std::sqrt(tuning::kMostSingle));  // so that pairs are no more than those
  if (singles.size() > most) singles.resize(most);
  candidates.clear();
  for (const Connection& single : singles) {
    for (const Bend& bend : bends) {
      const bool bothCurved = bend.kind != Bend::Kind::Plane && single.chain.curved() >= 0;
      if (!bothCurved && bend.surface != single.chain.bends[0].surface) candidates.push_back(prepend(bend, single));
    }
  }
  keep(withFlux(candidates, kCurvedSamples), most);
}

void LightConnections::add(const Connection& c) {
  index_.emplace(chainKey(c.light, c.chain), static_cast<int>(list_.size()));
  list_.push_back(c);
}

int LightConnections::find(LightId light, const BendChain& chain) const {
  const auto [begin, end] = index_.equal_range(chainKey(light, chain));
  for (auto it = begin; it != end; ++it) {
    const Connection& c = list_[it->second];
    if (c.light == light && sameChain(c.chain, chain)) return it->second;
  }
  return -1;
}

std::optional<Bend> LightConnections::mirror(PrimitiveId p, bool front) const {
  const Shape& shape = scene_.scene()[p].shape;
  if (!scene_.isConnectableMirror(p, front)) return std::nullopt;
  if (planeOf(shape)) return Bend{Bend::Kind::Plane, p};
  if (isCurvedMirror(shape)) return Bend{Bend::Kind::Curved, p};
  return std::nullopt;
}

std::optional<Bend> LightConnections::ball(PrimitiveId p, int inner) const {
  const auto* sphere = std::get_if<Sphere>(&scene_.scene()[p].shape);
  const Dielectric* body = scene_.body(p);
  if (!sphere || sphere->inward || !body || body->ior <= 1.0f || inner > kMostInner) return std::nullopt;
  return Bend{Bend::Kind::Ball, p, inner};
}

std::vector<Bend> LightConnections::findBends() const {
  std::vector<Bend> bends;
  for (std::size_t i = 0; i < scene_.scene().primitives.size(); ++i) {
    const PrimitiveId p(i);
    for (bool front : {true, false}) {
      if (isBlack(scene::mirrorReflectance(scene_.bsdf(p, front), 0.5))) continue;
      const auto bend = mirror(p, front);
      if (!bend) continue;
      bends.push_back(*bend);
      break;
    }
    for (int inner = 0; const auto through = ball(p, inner); ++inner) bends.push_back(*through);
  }
  return bends;
}

/// The candidates whose first bend gets light, brightest first. `samples` 0: as many as the bend's kind asks for.
std::vector<Connection> LightConnections::withFlux(std::vector<Connection> candidates, int samples) const {
  parallelFor(candidates.size(), 16, [&](std::size_t i) {
    Connection& c = candidates[i];
    Connection before{c.light, {}, 0};
    for (int k = 1; k < c.chain.count; ++k) before.chain.add(c.chain.bends[k]);
    const Bend& bend = c.chain.bends[0];
    const int usual = bend.kind == Bend::Kind::Plane ? kPlaneSamples : kCurvedSamples;
    c.flux = fluxLeaving(bend, before, samples > 0 ? samples : usual);
  });
  std::erase_if(candidates, [](const Connection& c) { return !(c.flux > 0.0); });
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.flux > b.flux; });
  return candidates;
}

double LightConnections::fluxLeaving(const Bend& bend, const Connection& before, int samples) const {
  const Shape& shape = scene_.scene()[bend.surface].shape;
  Rng rng(combineKeys(chainKey(before.light, before.chain), bend.surface.value));
  double flux = 0;
  for (int i = 0; i < samples; ++i) {
    const SurfacePoint p = deltalux::samplePoint(shape, {rng.uniform(), rng.uniform()});
    const Arrivals arrivals = sample(before, p.position, p.normal, {rng.uniform(), rng.uniform()});
    for (int k = 0; k < arrivals.count; ++k) {
      const Arrival& a = arrivals.list[k];
      const double cosine = glm::dot(a.direction, p.normal);
      const bool front = cosine > 0.0;
      Rgb passed(0.0f);
      if (bend.kind == Bend::Kind::Ball) {
        if (!front) continue;
        const Rgb F = scene::mirrorReflectance(scene_.bsdf(bend.surface, true), cosine);
        passed = (Rgb(1.0f) - F) * (Rgb(1.0f) - F) * glm::pow(F, Rgb(static_cast<float>(bend.inner)));
      } else if (mirror(bend.surface, front)) {
        passed = scene::mirrorReflectance(scene_.bsdf(bend.surface, front), std::abs(cosine));
      }
      if (isBlack(passed)) continue;
      for (int l = 0; l < a.legCount && !isBlack(passed); ++l) passed *= scene_.rays().transmittance(a.legs[l]);
      flux += gray(passed * a.value) * std::abs(cosine);
    }
  }
  return flux * area(shape) / samples;
}

}  // namespace deltalux::rendering
