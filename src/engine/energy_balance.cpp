#include "engine/energy_balance.hpp"

#include <algorithm>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "base/square.hpp"
#include "base/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "hierarchy/side_locator.hpp"
#include "lines/lines.hpp"
#include "particles/bounce.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kBlock = 1024;  // [task]
constexpr int kPanes = 64;            // [limit]
/// Rays that measure what particles bring, and lines that measure where light ends: their noise is negligible.
constexpr auto kLedgerSamples =
    static_cast<std::size_t>(1 / square(double(deltalux::tuning::kNegligible)));  // [defined]
constexpr std::uint64_t kKey = 0x62616c616e63657aull;                             // [key]

struct Surfaces {
  RgbSum direct{0.0}, absorbed{0.0};  // [W]

  Surfaces& operator+=(const Surfaces& o) { return direct += o.direct, absorbed += o.absorbed, *this; }
};

/// What passes a surface with diffuse sides straight, at any angle.
Rgb beside(const Material& m) { return passesStraight(m) ? straightTransmittance(m, 1.0) : Rgb(0.0f); }

/// What a surface passes on over its specular part of light that lines bring: what goes on along lines is not absorbed.
Rgb passedOnByLines(const Solution& s, const Material& m, bool front) {
  if (s.settings.method != SolveMethod::Lines || s.settings.diffuseOnly) return Rgb(0.0f);
  const scene::Bsdf bsdf = scene::makeBsdf(m, front);
  return bsdf.reflection.reflectance + bsdf.transmission.reflectance;
}

Surfaces surfacesOf(const Solution& s) {
  const hierarchy::Elements& elements = s.elements;
  const particles::ParticleSurfaces particles(s.scene);
  return parallelSum<Surfaces>(elements.size(), kBlock, [&](std::size_t e) {
    // What mirrors get, particles account for.
    if (!elements.isReceivingLeaf(hierarchy::ElementId(e)) ||
        !particles.takes(elements.domain[e].primitive, elements.topology[e].front))
      return Surfaces{};
    const hierarchy::ElementLight& l = elements.radiometry[e];
    const double A = elements.geometry[e].litArea();
    // What goes straight on through a cover counts where it ends; that of particles is theirs.
    const Rgb met = Rgb(1.0f) - beside(s.scene.materialOf(elements.domain[e].primitive));
    const Rgb onward = passedOnByLines(s, s.scene.materialOf(elements.domain[e].primitive), elements.topology[e].front);
    return Surfaces{A * RgbSum(met * l.direct),
                    A * RgbSum((met - l.rho - l.tau) * (l.direct + l.indirect) - onward * l.indirect +
                               (Rgb(1.0f) - l.rho - l.tau) * l.particle)};
  });
}

struct Outcome {
  RgbSum escaped{0.0}, panes{0.0}, gaps{0.0};

  Outcome& operator+=(const Outcome& o) { return escaped += o.escaped, panes += o.panes, gaps += o.gaps, *this; }
};

/// What covered parts of leaves would send, which do not: rays start there, too.
RgbSum sentUnderCovers(const hierarchy::Elements& elements) {
  return parallelSum<RgbSum>(elements.size(), kBlock, [&](std::size_t e) {
    const hierarchy::ElementGeometry& g = elements.geometry[e];
    return elements.isReceivingLeaf(hierarchy::ElementId(e))
               ? (double(g.area) - double(g.litArea())) * RgbSum(elements.radiometry[e].B)
               : RgbSum(0.0);
  });
}

/// Calls outcome(leaf, flux, index) of parts of all that leaves send, in proportion to the power of each; the sum.
/// `areaOf(element)`: what sends.
template <class AreaOf, class OutcomeOf>
Outcome ofSentLight(const hierarchy::Elements& elements, std::size_t parts, const AreaOf& areaOf,
                    const OutcomeOf& outcome) {
  std::vector<double> power{0.0};
  for (std::size_t e = 0; e < elements.size(); ++e)
    power.push_back(power.back() + (elements.isReceivingLeaf(hierarchy::ElementId(e))
                                        ? areaOf(e) * double(gray(elements.radiometry[e].B))
                                        : 0.0));
  const double total = power.back();
  if (!(total > 0)) return {};
  return parallelSum<Outcome>(parts, kBlock, [&](std::size_t i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(parts) * total;
    const auto e =
        static_cast<std::size_t>(std::upper_bound(power.begin() + 1, power.end() - 1, u) - power.begin() - 1);
    const Rgb B = elements.radiometry[e].B;
    return outcome(hierarchy::ElementId(e), total / static_cast<double>(parts) / double(gray(B)) * RgbSum(B), i);
  });
}

/// What becomes of light that diffuse surfaces send and that reaches none: rays from all over leaves.
Outcome diffuseLight(const Solution& s) {
  const hierarchy::Elements& elements = s.elements;
  const auto whole = [&](std::size_t e) { return double(elements.geometry[e].area); };
  Outcome all =
      ofSentLight(elements, kLedgerSamples, whole, [&](hierarchy::ElementId leaf, RgbSum flux, std::size_t i) {
        const auto index = static_cast<std::uint32_t>(i);
        const UnitPair at = scrambledSobol(index, kKey), to = scrambledSobol(index, ~kKey);
        const hierarchy::PatchPoint x = hierarchy::samplePatch(elements, s.scene, leaf, at.x, at.y);
        tracing::Ray ray;
        ray.direction = Vec3f(cosineDirection(Frame(Vec3(x.normal)), to.x, to.y));
        ray.origin = tracing::offsetOrigin(x.position, x.normal, ray.direction);
        Outcome outcome;
        for (int pane = 0; pane < kPanes; ++pane) {
          const tracing::Hit hit = s.tracer->closestHit(ray);
          if (!hit) {
            outcome.escaped = flux;
            break;
          }
          const Material& material = s.scene.materialOf(hit.primitive);
          if (!passesStraight(material)) {
            if (scene::stopsLight(material) && !elements.side(hit.primitive, hit.triangle, hit.front).valid())
              outcome.gaps += flux;
            break;
          }
          const double cosine = std::abs(glm::dot(Vec3(hit.normal), Vec3(ray.direction)));
          const RgbSum passes(straightTransmittance(material, cosine));
          if (isPane(material)) {
            // What they reflect is particles' light, or nobody's.
            const RgbSum reflects(s.settings.diffuseOnly
                                      ? Rgb(0.0f)
                                      : scene::mirrorReflectance(scene::makeBsdf(material, hit.front), cosine));
            outcome.panes += flux * (1.0 - passes - reflects);
          } else if (!elements.side(hit.primitive, hit.triangle, hit.front).valid()) {
            outcome.gaps += flux * (1.0 - passes);
          }
          flux *= passes;
          ray.origin = tracing::offsetOrigin(hit.position, hit.normal, ray.direction);
        }
        return outcome;
      });
  all.gaps -= sentUnderCovers(elements);
  return all;
}

/// The same where light is exchanged by lines, which go on over mirrors, gloss and glass: by some of those lines,
/// traced again.
Outcome lineLight(const Solution& s) {
  const hierarchy::Elements& elements = s.elements;
  const lines::SurfaceResponses responses(s.scene, !s.settings.diffuseOnly);
  const lines::LineTracer tracer(s.scene, *s.tracer, responses);
  const auto open = [&](std::size_t e) { return double(elements.geometry[e].litArea()); };
  return ofSentLight(elements, kLedgerSamples, open, [&](hierarchy::ElementId leaf, const RgbSum& flux, std::size_t i) {
    Outcome outcome;
    const std::span<const std::uint32_t> ends = s.lines.endsOf(leaf);
    const auto count = static_cast<std::uint32_t>(ends.size());
    if (count == 0) return outcome;
    // The next of its lines that is there.
    auto k = static_cast<std::uint32_t>(toUnit(combineKeys(kKey, i)) * count);
    for (std::uint32_t tries = 0; tries < count && ends[k] == lines::kCovered; ++tries) k = (k + 1) % count;
    const hierarchy::LeafSequence points(elements, s.scene, leaf);
    const hierarchy::PatchPoint x = points.point(k);
    const lines::LineEnd end = tracer.follow(x.position, x.normal, lines::LineDirections(points.key())(k, x.normal),
                                             lines::LineDirections::random(points.key(), k));
    outcome.panes = flux * RgbSum(end.absorbed);
    if (end.termination == lines::LineTermination::Escaped) outcome.escaped = flux * RgbSum(end.weight);
    return outcome;
  });
}

struct Specular {
  RgbSum ofLights{0.0}, passed{0.0}, absorbed{0.0}, escaped{0.0};

  Specular& operator+=(const Specular& o) {
    return ofLights += o.ofLights, passed += o.passed, absorbed += o.absorbed, escaped += o.escaped, *this;
  }
};

Specular specularLight(const Solution& s, const particles::ParticleTransfer& transfer) {
  const particles::Particles& p = s.particles;
  return parallelSum<Specular>(p.paths(), kBlock, [&](std::size_t path) {
    Specular sum;
    if (!(p.termination[path] & particles::kArrived)) return sum;
    const particles::SenderCell& cell = p.senderCells[p.sender[path]];
    const RgbSum power = double(p.links[p.link[path]].scale) * RgbSum(transfer.power(path, s.elements, s.scene));
    if (cell.kind != particles::SenderKind::Side) sum.ofLights = power * RgbSum(p.account[path].entered.value());
    sum.passed = power * RgbSum(p.account[path].passed.value());
    sum.absorbed = power * RgbSum(p.account[path].absorbed.value());
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      if (!transfer.placed(i)) sum.absorbed += power * RgbSum(p.throughput[i]);
    if (!(p.termination[path] & particles::kCut)) sum.escaped = power * RgbSum(p.account[path].left.value());
    return sum;
  });
}

}  // namespace

double emittedPower(const Solution& s, const particles::ParticleTransfer& transfer) {
  return s.scene.metresPerUnit * s.scene.metresPerUnit *
         gray(surfacesOf(s).direct + specularLight(s, transfer).ofLights);
}

EnergyLedger energyBalance(const Solution& s, const particles::ParticleTransfer& transfer, const RgbSum& residual) {
  const Surfaces surfaces = surfacesOf(s);
  const Outcome diffuse = s.settings.method == SolveMethod::Lines ? lineLight(s) : diffuseLight(s);
  const Specular specular = specularLight(s, transfer);
  const double unit = s.scene.metresPerUnit * s.scene.metresPerUnit;
  EnergyLedger ledger;
  ledger.emittedW = unit * gray(surfaces.direct + specular.ofLights);
  ledger.absorbedW =
      unit * gray(surfaces.absorbed - specular.passed + specular.absorbed + diffuse.panes + diffuse.gaps);
  ledger.escapedW = unit * gray(diffuse.escaped + specular.escaped);
  ledger.unsettledW = unit * gray(residual);
  return ledger;
}

}  // namespace deltalux::engine
