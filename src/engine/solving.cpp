// A scene is solved in rounds: links are refined, light settles over them, until they are as fine as the target error
// asks; then every leaf gets its row of transfers, and light settles over rows.
#include <algorithm>
#include <deltalux/error.hpp>
#include <utility>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "engine/energy_balance.hpp"
#include "engine/particle_count.hpp"
#include "engine/state.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/pull.hpp"
#include "paper/coarse_solution.hpp"
#include "paper/gather.hpp"
#include "paper/push_pull.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/reached_sides.hpp"
#include "radiosity/direct_senders.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux {

namespace {

constexpr double kFirstError = 64.0;   // of the links, relative to the target, in the first round
constexpr double kErrorFactor = 0.35;  // from round to round
constexpr double kHasty = 8.0;         // first round when time is limited, against the first otherwise
constexpr double kPreview = 8.0;       // the same, for a first look: its picture is there in a second or two
constexpr double kSettled = 1e-3;      // unsettled power, relative to emitted
constexpr int kMaxIterations = 64;

}  // namespace

SolveReport Engine::State::step(Progress* progress) {
  const engine::Clock time;
  Solution& s = *solution;
  if (byLines()) {
    lineRound(progress);
    s.report.times.total += time.seconds();
    return s.report;
  }
  if (!s.elements.sceneRoot.valid() && s.elements.size() == 0) prepare(progress);
  if (s.elements.sceneRoot.valid())
    byPaper() ? paperRound(progress) : round(progress);
  else
    s.report.converged = finished = true;
  s.report.times.total += time.seconds();
  return s.report;
}

void Engine::State::lineRound(Progress* progress) {
  Solution& s = *solution;
  if (!lineSolve) {
    budget = engine::TimeBudget(s.settings.seconds, clock.seconds());
    lineSolve = engine::solveCoarsely(s, known ? &*known : nullptr, budget, progress);
    countParticles();
    if (!s.elements.sceneRoot.valid()) {
      finished = s.report.converged = true;
      return;
    }
    if (previewed) {  // something to look at before the mesh is fine
      makeTextures(), count();
      s.report.converged = false;
      return;
    }
  }
  finished = true;
  s.report.converged = engine::solveFinely(*lineSolve, budget, progress);
  counts.leavesChanged = engine::changedLeaves(*lineSolve);
  transfer = std::move(lineSolve->transfer);
  if (!budget.limited()) s.memory = engine::memoryOf(std::move(*lineSolve));
  lineSolve.reset(), known.reset();
  followTextures();
  count();
  budget = engine::TimeBudget(0);  // updates take what time they need
}

void Engine::State::prepare(Progress* progress) {
  Solution& s = *solution;
  const engine::Clock time;
  budget = engine::TimeBudget(s.settings.seconds, clock.seconds());
  paper::CoarseReport coarse;
  auto sides = paper::coarseSolution(s.scene, *s.tracer, &coarse);
  trace();
  particles::addReachedSides(sides, s.particles, s.scene, *s.tracer);
  s.elements = hierarchy::buildElements(s.scene, sides);
  hierarchy::pull(s.elements);
  DELTALUX_VALIDATED(validate(s.elements));
  s.report.counts.raysVisibility += coarse.rays;
  s.report.times.hierarchy += time.seconds() - s.report.times.particles;
  nextError = (byPaper() ? linksJudged().error : s.settings.error) * kFirstError *
              (previewed          ? kPreview
               : budget.limited() ? kHasty
                                  : 1.0);
  if (progress) progress->report("hierarchy", 1.0);
}

void Engine::State::trace() {
  Solution& s = *solution;
  if (s.settings.diffuseOnly) return;
  const engine::Clock time;
  const std::uint64_t wanted = engine::particleCount(s.settings);
  tracing.emplace(s.scene, *s.tracer, particles::ParticleSettings{wanted, s.settings.seed});
  s.particles = budget.limited() ? tracing->traceWithin(engine::kParticleTime * budget.seconds()) : tracing->trace();
  curtailed = tracing->count() < wanted;
  if (curtailed) s.settings.particles = tracing->count();  // updates trace as many
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  s.report.times.particles += time.seconds();
  countParticles();
}

void Engine::State::countParticles() {
  Solution& s = *solution;
  WorkCounts& c = s.report.counts;
  c.linksDs = s.particles.links.size();
  c.particles = s.particles.arrived();
  c.impacts = s.particles.impacts();
  s.report.cutParticles = s.particles.cut();
  c.raysParticles = s.particles.rays + s.particles.looks;
  s.report.memory.particles = s.particles.memoryBytes();
}

void Engine::State::round(Progress* progress) {
  Solution& s = *solution;
  paper::OracleSettings oracle;
  const double least = s.settings.error * engine::kLastError;
  oracle.error = std::max(nextError, least);
  const bool last = oracle.error <= least;
  const paper::RefineReport refined = refineLinks(oracle, progress);

  subdivideForParticles();

  const engine::Clock gathering;
  bool settled = settle(progress);
  radiosity::LeafTransferSettings leaves;
  leaves.error = s.settings.error;
  nextError = std::max(least, oracle.error * kErrorFactor);
  bool whole = true;
  if (budget.limited()) {
    const double needed = engine::leafRoundSeconds(s.elements, s.links, s.scene, *s.tracer, leaves);
    const double left = budget.left() - engine::kEndingTime * budget.seconds();
    nextError = budget.reach(paper::LinkErrors(s.links, s.elements, oracle), oracle.error, nextError, left - needed);
    whole = needed <= left;
    leaves = engine::shrunk(leaves, needed, left);
  }
  finished = last || refined.stopped || !(nextError < oracle.error);
  if (finished) settled = resolve(leaves, progress);
  s.report.times.gather += gathering.seconds();
  if (finished) makeTextures();
  count();
  const bool limited = budget.limited();
  if (finished) budget = engine::TimeBudget(0);  // updates take what time they need
  if (!limited) prepareToFollow();               // or the first edit does
  s.report.converged = settled && whole && last && !refined.stopped && !curtailed;
}

void Engine::State::subdivideForParticles() {
  Solution& s = *solution;
  const caustics::SurfaceSides shown = chooseTextures();
  const engine::Clock placing;
  particles::subdivideForParticles(s.elements, s.scene, s.particles, shown);
  s.report.times.particles += placing.seconds();
}

paper::RefineReport Engine::State::refineLinks(const paper::OracleSettings& oracle, Progress* progress) {
  Solution& s = *solution;
  const double predicted = budget.limited() ? paper::LinkErrors(s.links, s.elements, oracle).madeBy(oracle.error) : 0;
  const engine::Clock time;
  const paper::RefineReport refined = paper::refine(s.links, s.elements, s.scene, *s.tracer, oracle, [&] {
    if (progress && progress->stopRequested()) throw Interrupted();
    return budget.limited() && budget.left() < 0;
  });
  DELTALUX_VALIDATED(validate(s.links, s.elements));
  budget.learn(time.seconds(), predicted, static_cast<double>(refined.created));
  s.report.times.refine += time.seconds();
  s.report.counts.raysVisibility += refined.rays;
  s.report.provenClear += refined.provenClear;
  s.report.provenBlocked += refined.provenBlocked;
  return refined;
}

caustics::SurfaceSides Engine::State::chooseTextures() {
  Solution& s = *solution;
  if (s.particles.impacts() == 0 || !s.settings.causticTextures)
    return caustics::SurfaceSides(2 * s.scene.primitives.size(), false);
  const engine::Clock time;
  caustics::SurfaceSides sides = caustics::sidesWithTextures(
      s.scene, s.elements, particles::impacts(s.particles, s.elements, s.scene), s.settings.error);
  s.report.times.textures += time.seconds();
  return sides;
}

void Engine::State::makeTextures() {
  Solution& s = *solution;
  const engine::Clock time;
  std::vector<particles::Impact> landed;
  // The mesh shows what no texture does.
  if (s.settings.causticTextures && !budget.up()) landed = particles::impacts(s.particles, s.elements, s.scene);
  s.caustics = caustics::makeCaustics(s.scene, s.elements, std::move(landed), s.settings.error);
  DELTALUX_VALIDATED(validate(s.caustics));
  s.report.times.textures += time.seconds();
  countTextures();
}

void Engine::State::followTextures() {
  Solution& s = *solution;
  if (!upkeep || !newPaths) {
    makeTextures();
    counts.texturesRebuilt = s.caustics.count();
    return;
  }
  const engine::Clock time;
  counts.texturesRebuilt = upkeep->follow(*std::exchange(newPaths, {}), *transfer, s.caustics).rebuilt;
  DELTALUX_VALIDATED(validate(s.caustics));
  s.report.times.textures += time.seconds();
  countTextures();
}

void Engine::State::countTextures() {
  Solution& s = *solution;
  s.report.counts.causticTextures = s.caustics.count();
  s.report.counts.causticTextureMeanSize = s.caustics.meanSize();
  s.report.memory.textures = s.caustics.memoryBytes() + (upkeep ? upkeep->memoryBytes() : 0);
}

bool Engine::State::settle(Progress* progress) {
  Solution& s = *solution;
  const paper::GatherPlan plan(s.links, s.elements);
  plan.gatherDirect(s.elements);
  const particles::ParticleTransfer onMesh(s.particles, s.elements, s.scene);
  RgbSum emitted(0.0);
  for (int i = 0; i < kMaxIterations; ++i) {
    plan.gatherIndirect(s.elements);
    onMesh.apply(s.elements, scene::scalesOf(s.scene));
    unsettled = paper::pushPull(s.elements);
    ++s.report.counts.iterations;
    emitted = directPower();
    if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
    if (gray(unsettled) <= kSettled * gray(emitted)) break;
    if (budget.up()) break;  // rows are settled anyway
  }
  return gray(unsettled) <= kSettled * gray(emitted);
}

void Engine::State::solveAfresh(Progress* progress) {
  Solution& s = *solution;
  if (!known) s.tracer = tracing::makeEmbreeTracer(s.scene), s.memory.reset();
  transfer.reset(), settling.reset(), backlog = {};
  if (!known) tracing.reset(), newPaths.reset(), groups = {}, s.particles = {};
  if (!newPaths) upkeep.reset(), s.caustics = {};
  s.elements = {}, s.links = {}, s.transfers = {}, s.lines = {}, s.deviation.clear(), lineSolve.reset();
  s.report = {};
  finished = false;
  clock = {};
  while (!finished) step(progress);
}

bool Engine::State::resolve(const radiosity::LeafTransferSettings& settings, Progress* progress) {
  Solution& s = *solution;
  transfer.reset(), settling.reset(), upkeep.reset();  // of the rows and the mesh that there were
  radiosity::creditLights(s.elements);
  const radiosity::LeafTransferReport r = s.transfers.build(s.elements, s.links, s.scene, *s.tracer, settings);
  s.report.counts.raysVisibility += r.rays;
  s.sampledScale.clear();
  for (const Light& light : s.scene.lights) s.sampledScale.push_back(light.scale);
  const bool settled = settleRows(progress);
  if (!budget.up()) settleCorners();
  return settled;
}

/// Where light goes round for long in a corner that has little of it, what is unsettled of all light tells nothing. The
/// first update would be left to settle that.
void Engine::State::settleCorners() {
  Solution& s = *solution;
  settling.emplace(engine::LightSettling::Parts{s.scene, s.transfers, *transfer}, s.elements);
  engine::LightChanges all;
  all.rows = s.transfers.leaves();
  settleOver(all);
}

bool Engine::State::settleRows(Progress* progress) {
  Solution& s = *solution;
  s.transfers.gatherDirect(s.elements);
  hierarchy::pull(s.elements);
  const RgbSum emitted = directPower();
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  for (int i = 0; i < engine::kMaxRowIterations; ++i) {
    s.transfers.gatherIndirect(s.elements);
    transfer->apply(s.elements, scene::scalesOf(s.scene));
    unsettled = hierarchy::pull(s.elements);
    ++s.report.counts.iterations;
    if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
    if (gray(unsettled) <= (budget.up() ? kSettled : engine::kSettledWell) * gray(emitted)) break;
  }
  return gray(unsettled) <= engine::kSettledRows * gray(emitted);
}

RgbSum Engine::State::directPower() const {
  const hierarchy::Elements& e = solution->elements;
  return parallelSum<RgbSum>(e.inputs.size(), 4096, [&](std::size_t i) {
    const hierarchy::ElementId input = e.inputs[i];
    return e.receives(input) ? double(e.shape(input).litArea()) * RgbSum(e.radiometry[input.index()].direct)
                             : RgbSum(0.0);
  });
}

EnergyLedger Engine::State::balance() {
  Solution& s = *solution;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  return engine::energyBalance(s, *transfer, unsettled);
}

void Engine::State::countLight() {
  Solution& s = *solution;
  if (finished && !updated) s.report.energy = balance();
  if (finished && updated) {
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    s.report.energy = {engine::emittedPower(s, *transfer), {}, {}, {}};
  }
  s.report.memory.peakRss = peakResidentBytes();
  counted = true;
}

void Engine::State::count() {
  Solution& s = *solution;
  countLight();
  WorkCounts& c = s.report.counts;
  c.elements = s.elements.size();
  c.leafElements = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    c.leafElements += solution->elements.isReceivingLeaf(hierarchy::ElementId(i));
  c.links = s.links.size();
  s.report.activeLinks = 0;
  for (const hierarchy::Link& l : s.links.all) s.report.activeLinks += l.state == hierarchy::LinkState::Active;
  s.report.memory.elements = s.elements.memoryBytes();
  s.report.memory.links = s.links.memoryBytes() + s.transfers.memoryBytes();
  s.report.memory.octree = tracing ? tracing->watchBytes() : 0;
}

}  // namespace deltalux
