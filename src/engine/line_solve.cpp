#include "engine/line_solve.hpp"
#include "base/sky_side.hpp"
#include "direct/tuning.hpp"
#include "engine/tuning.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/check_interrupted.hpp"
#include "base/tuning.hpp"
#include "caustics/choice.hpp"
#include "engine/clock.hpp"
#include "engine/light_columns.hpp"
#include "engine/particle_settings.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/fold.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/pull.hpp"
#include "lines/line_counts.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/particle_tracing.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::engine {

namespace {

/// Exchanges the direct light of the input level for that of its coarse solution, or back.
void swapCoarse(PatchSamples& samples, std::span<const hierarchy::ElementId> inputs) {
  for (const hierarchy::ElementId e : inputs)
    if (WholeLight* coarse = samples.coarse[e.index()].get()) std::swap(samples.direct[e.index()], coarse->light);
}

/// Into cells of which shadow rays to a point choose.
void divideSkies(hierarchy::Elements& elements, const Scene& scene) {
  std::vector<hierarchy::ElementId> cells = elements.distant;
  for (int level = 0; 2 * level < kSkyHalvings; ++level) {
    std::vector<hierarchy::ElementId> parts;
    for (const hierarchy::ElementId e : cells)
      if (hierarchy::subdivide(elements, scene, e))
        for (std::size_t c = 0; c < elements.at(e).childCount; ++c) parts.push_back(elements.child(e, c));
    cells = std::move(parts);
  }
}

hierarchy::Elements inputElements(const Scene& scene) {
  std::vector<hierarchy::FaceOrder> orders = hierarchy::faceOrders(scene);
  const std::vector<hierarchy::SurfaceSide> sides = hierarchy::surfaceSides(scene, orders);
  hierarchy::Elements elements = hierarchy::buildElements(scene, sides, std::move(orders));
  if (elements.sceneRoot.valid()) divideSkies(elements, scene);
  return elements;
}

std::vector<hierarchy::ElementId> receivingInputs(const hierarchy::Elements& elements) {
  std::vector<hierarchy::ElementId> inputs;
  for (const hierarchy::ElementId e : elements.inputs)
    if (elements.receives(e)) inputs.push_back(e);
  return inputs;
}

/// What particles reach is not enclosed, whatever walks have found.
void openToParticles(LineSolve& x) {
  const particles::Particles& p = x.s.particles;
  for (std::size_t path = 0; path < p.paths(); ++path)
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      const hierarchy::ElementId side =
          x.s.elements.side(p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0);
      if (side.valid()) x.enclosed[hierarchy::surfaceOf(x.s.elements, side).index()] = 0;
    }
}

bool traceParticles(Solution& s, const TimeBudget& budget) {
  if (s.settings.diffuseOnly) return true;
  const particles::ParticleSettings settings = particleSettings(s.settings);
  const std::uint64_t wanted = settings.count;
  particles::ParticleTracing tracing(s.scene, *s.tracer, settings);
  s.particles = budget.limited() ? tracing.traceWithin(budget.share()) : tracing.trace();
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  return tracing.count() >= wanted;
}

/// Where particles lie on the elements: by what followed them from before, if anything did.
particles::ParticleTransfer transferOf(const Solution& s, std::optional<particles::ParticleTransfer> before,
                                       const KnownSolve* known) {
  if (!before) return {s.particles, s.elements, s.scene};
  before->follow(s.particles, known->retraced(), s.elements, s.scene);
  before->followAllPatches(s.elements);
  return std::move(*before);
}

/// The light of the lines, by groups of lights.
void keepColumns(LineSolve& x, Progress* progress) {
  const hierarchy::LeafTable leaves(x.s.elements);
  if (!x.transfer) x.transfer.emplace(x.s.particles, x.s.elements, x.s.scene);
  keepLightsApart(x.s, {leaves, *x.exchange, lampsOf(x.samples, x.dim, leaves), x.sky, x.skies, x.nominal, *x.transfer},
                  progress);
}

/// Sides whose particles textures show need no fine mesh for them.
void refineForParticles(LineSolve& x) {
  Solution& s = x.s;
  if (s.particles.impacts() == 0) return;
  caustics::SurfaceSides shown(2 * s.scene.primitives.size(), false);
  if (s.settings.causticTextures)
    shown = caustics::sidesWithTextures(
        s.scene, s.elements, particles::impacts(s.particles, s.elements, s.scene, x.nominal), s.settings.error);
  particles::subdivideForParticles(s.elements, s.scene, s.particles, shown, x.details);
  std::vector<hierarchy::ElementId> parts;
  x.resizeSamples();
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementId e(i);
    if (x.measured[i] || !s.elements.receives(e)) continue;
    // Nobody has asked it what it may have been asked before.
    if (s.elements.isLeaf(e))
      parts.push_back(e), x.samples.evaluated[i].reset();
    else
      x.samples.forget(i);
  }
  samplePatches(x, parts);
}

}  // namespace

double floorOf(const hierarchy::Elements& elements) {
  double light = 0, area = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const hierarchy::ElementLight& l = elements.radiometry[i];
    const double A = elements.geometry[i].litArea();
    light += A * gray(l.direct + l.indirect + l.particle), area += A;
  }
  return area > 0 ? direct::tuning::kFloor * light / area : 0;
}

LineSolve::LineSolve(Solution& solution, KnownSolve* before)
    : s(solution),
      known(before),
      responses(s.scene, !s.settings.diffuseOnly),
      tracer(s.scene, *s.tracer, responses),
      cover(s.scene, *s.tracer),
      nominal(scene::nominalScales(s.scene)),
      lamps(s.scene, nominal),
      skies(s.scene) {}

bool LineSolve::takesPart(hierarchy::ElementId patch) const {
  return !enclosed[hierarchy::surfaceOf(s.elements, patch).index()];
}

std::size_t changedLeaves(const LineSolve& x) {
  const hierarchy::LeafTable leaves(x.s.elements);
  if (!x.knownLines) return leaves.size();
  return static_cast<std::size_t>(std::ranges::count_if(
      leaves.leaves, [&](hierarchy::ElementId leaf) { return !x.knownLines->whole[leaf.index()]; }));
}

std::shared_ptr<SolveMemory> memoryOf(LineSolve&& x) {
  auto memory = std::make_shared<SolveMemory>();
  memory->samples = std::move(x.samples);
  memory->walks = std::move(x.walks), memory->enclosed = std::move(x.enclosed);
  memory->escaped = std::move(x.escaped), memory->bends = std::move(x.bends);
  memory->sky = std::move(x.sky), memory->dim = std::move(x.dim), memory->exchange = std::move(x.exchange);
  memory->details = std::move(x.details);
  memory->coarse = std::move(x.coarse);
  memory->coarseTransfer = std::move(x.coarseTransfer);
  memory->plain = x.responses.plain();
  memory->nominal = std::move(x.nominal), memory->lampTree = x.lamps.tree();
  return memory;
}

std::unique_ptr<LineSolve> solveCoarsely(Solution& s, KnownSolve* known, const TimeBudget& budget, Progress* progress) {
  Clock watch;
  auto solve = std::make_unique<LineSolve>(s, known);
  solve->allParticles = known || traceParticles(s, budget);  // they have followed the edit
  s.report.times.particles += watch.lap();
  if (progress) progress->report("particles", 1.0);
  checkInterrupted(progress);

  const auto build = [&] { return inputElements(s.scene); };
  s.elements = known ? known->takeMesh(s.scene, build) : build();
  if (!s.elements.sceneRoot.valid()) return solve;
  if (known) {
    solve->samples = known->takeSamples(), solve->walks = known->takeWalks();
    solve->details = known->takeDetails(s.elements, s.particles);
  }
  const auto hold = [&](hierarchy::ElementId side, const lines::LightWalks& walks) {
    return known && known->holdsWalks(s.elements, side, walks);
  };
  s.report.counts.raysVisibility += lines::walkForLight(
      s.elements, solve->tracer, hold, known ? known->movedLights() : std::span<const char>(), solve->walks);
  for (const lines::LightWalks& w : solve->walks) solve->enclosed.push_back(w.enclosed);
  openToParticles(*solve);
  if (known) known->moveOpened(s.elements, solve->enclosed);
  s.report.times.hierarchy += watch.lap();
  checkInterrupted(progress);

  const std::vector<hierarchy::ElementId> inputs = receivingInputs(s.elements);
  sampleInputs(*solve, inputs);
  lines::setMeanFreePaths(s.elements, solve->samples.scale);
  solve->coarseTransfer = transferOf(s, known ? known->takeCoarseTransfer() : std::nullopt, known);
  solve->coarseTransfer->apply(s.elements, solve->nominal);
  swapCoarse(solve->samples, inputs);
  if (known) solve->sky = known->takeCoarseSky();
  lightLeaves(*solve, traceLeaves(*solve, deltalux::tuning::kPilots, &KnownSolve::takeCoarseLines, progress),
              Dimming::none(s.scene), deltalux::tuning::kNegligible, progress);
  for (const hierarchy::ElementId e : inputs) {
    hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    l.typical = gray(l.direct + l.indirect);
  }
  swapCoarse(solve->samples, inputs);
  solve->coarse = {{std::exchange(s.lines, {}), std::exchange(solve->escaped, {}), std::exchange(solve->bends, {}), 0},
                   std::exchange(solve->sky, {})};
  solve->exchange.reset();
  solve->floor = floorOf(s.elements);
  hierarchy::pull(s.elements);
  DELTALUX_VALIDATED(validate(s.elements));
  s.report.times.visibility += watch.lap();
  if (progress) progress->report("coarse light", 1.0);
  return solve;
}

bool solveFinely(LineSolve& x, const TimeBudget& budget, Progress* progress) {
  Solution& s = x.s;
  Clock watch;
  checkInterrupted(progress);
  const bool meshed = refineMesh(x, receivingInputs(s.elements), [&] {
    checkInterrupted(progress);
    return budget.limited() && budget.left() < budget.share();
  });
  if (!budget.up()) refineForParticles(x);
  hierarchy::forgetFolded(s.elements);
  x.transfer = transferOf(s, x.known ? x.known->takeTransfer() : std::nullopt, x.known);
  x.transfer->apply(s.elements, x.nominal);
  const std::vector<Rgb> scales = scene::scalesOf(s.scene);
  if (!x.known && scales == x.nominal) x.transfer.reset();  // what follows takes more memory than it takes time
  const double meshSeconds = watch.lap();
  s.report.times.refine += meshSeconds;
  if (progress) progress->report("mesh", 1.0);
  checkInterrupted(progress);

  const std::uint32_t wanted = lines::baseLines(s.settings.error);
  std::uint32_t base = wanted;
  if (budget.limited() && s.report.counts.raysVisibility > 0) {
    // A line takes about what a ray of the mesh took.
    const double leaves = static_cast<double>(hierarchy::LeafTable(s.elements).size());
    const double rate = static_cast<double>(s.report.counts.raysVisibility) /
                        std::max(meshSeconds + s.report.times.visibility + s.report.times.hierarchy, 1e-3);
    const double affordable = tuning::kPlanned * std::max(budget.left(), 0.0) * rate / std::max(leaves, 1.0);
    base = static_cast<std::uint32_t>(
        std::clamp(affordable, double(deltalux::tuning::kPilots), static_cast<double>(wanted)));
  }
  if (x.known) x.sky = x.known->takeSky(), x.exchange = x.known->takeExchange();
  lines::TracedLines traced = traceLeaves(x, base, &KnownSolve::takeLines, progress);
  if (scales != x.nominal) x.transfer->apply(s.elements, scales);
  lightLeaves(x, std::move(traced), Dimming::of(s.scene, x.skies), deltalux::tuning::kConverged, progress);
  hierarchy::pull(s.elements);
  if (s.settings.byLight) keepColumns(x, progress);
  DELTALUX_VALIDATED(validate(s.elements));
  s.report.times.gather += watch.lap();
  if (progress) progress->report("lines", 1.0);
  return meshed && base >= wanted && x.allParticles;
}

}  // namespace deltalux::engine
