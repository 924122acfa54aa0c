// A scene is solved in rounds: over lines a coarse one and a fine one (line_solve.hpp), over links many
// (paper_solve.cpp).
#include <utility>

#include "base/check.hpp"
#include "base/usual_error.hpp"
#include "engine/energy_balance.hpp"
#include "engine/state.hpp"
#include "hierarchy/fold.hpp"
#include "paper/caustic_textures.hpp"

namespace deltalux {

static_assert(SolveSettings{}.error == kUsualError);

SolveReport Engine::State::step(Progress* progress) {
  const engine::Clock time;
  byLines() ? lineRound(progress) : paperRound(progress);
  solution->report.times.total += time.seconds();
  return solution->report;
}

void Engine::State::lineRound(Progress* progress) {
  Solution& s = *solution;
  if (!lineSolve) {
    // What is known takes no time, and is all as the error asks for.
    budget = known ? engine::TimeBudget(0) : engine::TimeBudget(s.settings.seconds, clock.seconds());
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
  s.report.converged = engine::solveFinely(*lineSolve, budget, progress);
  finished = true;
  counts.leavesChanged = engine::changedLeaves(*lineSolve);
  transfer = std::move(lineSolve->transfer);
  // Of a solve that was cut short updates could not be what one without haste would be.
  if (s.report.converged) s.memory = engine::memoryOf(std::move(*lineSolve));
  lineSolve.reset(), known.reset();
  followTextures(counts);
  if (updated)
    counted = false;  // by whoever looks at the report
  else
    count();
  budget = engine::TimeBudget(0);  // updates take what time they need
}

void Engine::State::countParticles() {
  Solution& s = *solution;
  WorkCounts& c = s.report.counts;
  c.linksDs = s.particles.links.size();
  c.particles = s.particles.arrived();
  c.impacts = s.particles.impacts();
  s.report.cutParticles = s.particles.cut();
  c.raysParticles = s.particles.rays + s.particles.pilots;
  s.report.memory.particles = s.particles.memoryBytes();
}

void Engine::State::makeTextures() {
  Solution& s = *solution;
  const engine::Clock time;
  std::vector<particles::Impact> deposited;
  // The mesh shows what no texture does.
  if (s.settings.causticTextures && !budget.up()) deposited = particles::impacts(s.particles, s.elements, s.scene);
  s.caustics = caustics::makeCaustics(s.scene, s.elements, std::move(deposited), s.settings.error,
                                      byLines() ? caustics::adaptiveRule() : paper::textureRule());
  DELTALUX_VALIDATED(validate(s.caustics));
  s.report.times.textures += time.seconds();
  countTextures();
}

void Engine::State::followTextures(StepReport& step) {
  Solution& s = *solution;
  if (!textureUpdate || !newPaths) {
    makeTextures();
    step.texturesRebuilt = s.caustics.count();
    return;
  }
  const engine::Clock time;
  step.texturesRebuilt = textureUpdate->follow(*std::exchange(newPaths, {}), *transfer, s.caustics).rebuilt;
  DELTALUX_VALIDATED(validate(s.caustics));
  s.report.times.textures += time.seconds();
  countTextures();
}

void Engine::State::countTextures() {
  Solution& s = *solution;
  s.report.counts.causticTextures = s.caustics.count();
  s.report.counts.causticTextureMeanSize = s.caustics.meanSize();
  s.report.memory.textures = s.caustics.memoryBytes() + (textureUpdate ? textureUpdate->memoryBytes() : 0);
}

void Engine::State::solveAfresh(Progress* progress) {
  Solution& s = *solution;
  if (!known) s.tracer = tracing::makeEmbreeTracer(s.scene), s.memory.reset();
  transfer.reset();
  if (!known) incremental.reset(), tracing.reset(), newPaths.reset(), groups = {}, s.particles = {};
  if (!newPaths) textureUpdate.reset(), s.caustics = {};
  lists.reset();
  s.elements = {}, s.links = {}, s.lines = {}, s.columns = {}, s.deviation.clear(), lineSolve.reset();
  s.report = {};
  finished = false;
  clock = {};
  try {
    while (!finished) step(progress);
  } catch (...) {  // what was known is half taken: who goes on begins from nothing
    known.reset(), lineSolve.reset(), newPaths.reset(), textureUpdate.reset();
    throw;
  }
}

EnergyLedger Engine::State::balance() {
  Solution& s = *solution;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  return engine::energyBalance(s, *transfer, residual);
}

void Engine::State::count() {
  Solution& s = *solution;
  if (finished && !updated) s.report.energy = balance();
  if (finished && updated) {
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    s.report.energy = {engine::emittedPower(s, *transfer), {}, {}, {}};
  }
  s.report.memory.peakRss = peakResidentBytes();
  counted = true;
  if (byLines() && finished) s.report.error = engine::estimateError(s);
  WorkCounts& c = s.report.counts;
  c.elements = s.elements.size() - hierarchy::awayIn(s.elements);
  c.leafElements = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    c.leafElements += solution->elements.isReceivingLeaf(hierarchy::ElementId(i));
  c.links = s.links.size();
  s.report.memory.elements = s.elements.memoryBytes();
  s.report.memory.links = s.links.memoryBytes();
  s.report.memory.octree = incremental ? incremental->octreeBytes() : tracing ? tracing->watchBytes() : 0;
}

}  // namespace deltalux
