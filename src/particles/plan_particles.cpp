#include <algorithm>

#include "base/check.hpp"
#include "base/pilot_paths.hpp"
#include "base/tuning.hpp"
#include "particles/count_paths.hpp"
#include "particles/plan_particles.hpp"
#include "particles/trace.hpp"

namespace deltalux::particles {

namespace {

void nameSenders(const Senders& senders, const CoarseExitance& exitance, Particles& p) {
  p.senderCells = senders.cells();
  p.nominal = exitance.perCell;
  std::fill_n(p.nominal.begin(), senders.surfaceCells(), 1.0f);
}

/// Flux of particles by the diffuse cell that they land on.
std::vector<double> depositedFlux(const Particles& p, const Senders& senders) {
  std::vector<double> flux(senders.cells().size(), 0.0);
  for (std::size_t path = 0; path < p.paths(); ++path) {
    const double power = double(p.links[p.link[path]].scale) * p.nominal[p.sender[path]];
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      const std::uint32_t side = p.triangleAndSide[i];
      const std::uint32_t cell = senders.cellOf(p.primitive[i], side >> 1, (side & 1) == 0, Vec2(p.uv[i]));
      if (cell != RadixNode::kNone) flux[cell] += power * gray(p.throughput[i]);
    }
  }
  return flux;
}

void appendLinks(DsLinks& links, const DsLinks& more) {
  links.all.insert(links.all.end(), more.all.begin(), more.all.end());
  std::sort(links.all.begin(), links.all.end(), [](const DsLink& a, const DsLink& b) { return a.key < b.key; });
  links.flux += more.flux, links.rays += more.rays, links.evaluated += more.evaluated;
}

ParticlePlan plan(const Scene& scene, const tracing::RayTracer& tracer, const ParticleSettings& settings) {
  ParticlePlan result;
  const Receivers receivers(scene);
  if (receivers.empty() || settings.count == 0) return result;
  const scene::LightSampler lights(scene, std::vector<Rgb>(scene.lights.size(), Rgb(1.0f)));
  Senders senders(scene, lights);
  const ParticleEmission emission(scene, tracer, senders, receivers);
  CoarseExitance exitance{skyStrengths(scene, senders)};
  senders.weigh(exitance.perCell);
  DsLinks& links = result.links;
  const auto refine = [&](std::span<const std::uint32_t> roots) {
    DsSettings ds;
    ds.otherFlux = links.flux, ds.seed = settings.seed;
    return refineDsLinks(scene, tracer, emission, senders, receivers, exitance, roots, ds);
  };

  if (!settings.ofSurfaces) {
    links = refine(senders.lightRoots());
    nameSenders(senders, exitance, result.empty);
    result.empty.pilots = links.rays;
    return result;
  }
  // The light of lights first: surfaces that it reaches over mirrors and glass send on more than shadow rays know of.
  links = refine(senders.lightRoots());
  Particles pilots;
  nameSenders(senders, exitance, pilots);
  // Where few arrive each of them is dear.
  const double share = std::min(arrivingShare(links) / deltalux::tuning::kDefensive, 1.0);
  countPaths(links, share * kPilotPaths, pilots);
  tracePaths(scene, tracer, emission, settings.maxDepth, pilots);
  exitance = coarseExitance(scene, tracer, lights, senders, depositedFlux(pilots, senders));
  senders.weigh(exitance.perCell);
  appendLinks(links, refine(senders.surfaceRoots()));

  nameSenders(senders, exitance, result.empty);
  result.empty.pilots = exitance.rays + links.rays + pilots.rays;
  return result;
}

bool moved(const Scene& scene) {
  return std::any_of(scene.placements.begin(), scene.placements.end(),
                     [](const Placement& p) { return !p.present || p.matrix != Mat4(1.0); });
}

}  // namespace

ParticlePlan planParticles(const Scene& scene, const tracing::RayTracer& tracer, const ParticleSettings& settings) {
  if (!moved(scene)) return plan(scene, tracer, settings);
  Scene rest = scene;
  for (const Placement& p : scene.placements) rest.primitives[p.primitive.index()].shape = p.rest;
  rest.placements.clear();
  return plan(rest, *tracing::makeEmbreeTracer(rest), settings);
}

Particles counted(const ParticlePlan& plan, std::uint64_t count) {
  Particles p = plan.empty;
  countPaths(plan.links, static_cast<double>(count), p);
  return p;
}

}  // namespace deltalux::particles
