// Solves over links (paper/solve.hpp): its stages in order. Links are refined, light is iterated over them, until
// they are as fine as the target error asks.
#include <algorithm>

#include "base/check.hpp"
#include "base/check_interrupted.hpp"
#include "engine/particle_settings.hpp"
#include "engine/state.hpp"
#include "engine/tuning.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/pull.hpp"
#include "paper/caustic_textures.hpp"
#include "paper/coarse_solution.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/reached_sides.hpp"

namespace deltalux {

void Engine::State::paperRound(Progress* progress) {
  Solution& s = *solution;
  if (s.elements.size() == 0) prepare(progress);
  if (!s.elements.sceneRoot.valid()) {
    s.report.converged = finished = true;
    return;
  }
  paper::OracleSettings oracle = linkSettings();
  const double least = oracle.error;
  oracle.error = std::max(nextError, least);
  const bool last = oracle.error <= least;
  const paper::RefineReport refined = refineLinks(oracle, progress);

  const caustics::SurfaceSides shown = chooseTextures();
  const engine::Clock placing;
  particles::Details details;
  particles::subdivideForParticles(s.elements, s.scene, s.particles, shown, details);
  transfer.emplace(s.particles, s.elements, s.scene);
  s.report.times.particles += placing.seconds();

  nextError = paper::nextError(oracle.error, least);
  if (budget.limited()) {
    const double left = budget.left() - (1 - engine::tuning::kPlanned) * budget.seconds();
    nextError = budget.reach(paper::LinkErrors(s.links, s.elements, oracle), oracle.error, nextError, left);
  }
  finished = last || refined.stopped || !(nextError < oracle.error);
  const bool converged = iterateOverLinks(finished, progress);
  const bool limited = budget.limited();
  if (finished) {
    s.sampledScale.clear();
    for (const Light& light : s.scene.lights) s.sampledScale.push_back(light.scale);
    makeTextures();
  }
  count();
  if (finished) budget = engine::TimeBudget(0);  // updates take what time they need
  if (!limited) prepareToFollow();               // or the first edit does
  s.report.converged = converged && last && !refined.stopped && !curtailed;
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
  nextError = paper::firstError(linkSettings().error);
  if (progress) progress->report("hierarchy", 1.0);
}

void Engine::State::trace() {
  Solution& s = *solution;
  if (s.settings.diffuseOnly) return;
  const engine::Clock time;
  const particles::ParticleSettings settings = engine::particleSettings(s.settings);
  incremental.reset();
  tracing.emplace(s.scene, *s.tracer, settings);
  s.particles = budget.limited() ? tracing->traceWithin(budget.share()) : tracing->trace();
  curtailed = tracing->count() < settings.count;
  if (curtailed) s.settings.particles = tracing->count();  // updates trace as many
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  s.report.times.particles += time.seconds();
  countParticles();
}

paper::RefineReport Engine::State::refineLinks(const paper::OracleSettings& oracle, Progress* progress) {
  Solution& s = *solution;
  const double predicted = budget.limited() ? paper::LinkErrors(s.links, s.elements, oracle).madeBy(oracle.error) : 0;
  const engine::Clock time;
  const paper::RefineReport refined = paper::refine(s.links, s.elements, s.scene, *s.tracer, oracle, [&] {
    checkInterrupted(progress);
    return budget.limited() && budget.left() < 0;
  });
  DELTALUX_VALIDATED(validate(s.links, s.elements));
  budget.learn(time.seconds(), predicted, static_cast<double>(refined.created));
  s.report.times.refine += time.seconds();
  s.report.counts.raysVisibility += refined.rays;
  return refined;
}

caustics::SurfaceSides Engine::State::chooseTextures() {
  Solution& s = *solution;
  if (s.particles.impacts() == 0 || !s.settings.causticTextures)
    return caustics::SurfaceSides(2 * s.scene.primitives.size(), false);
  const engine::Clock time;
  caustics::SurfaceSides sides =
      caustics::sidesWithTextures(s.scene, s.elements, particles::impacts(s.particles, s.elements, s.scene),
                                  s.settings.error, paper::textureRule());
  s.report.times.textures += time.seconds();
  return sides;
}

bool Engine::State::iterateOverLinks(bool well, Progress* progress) {
  Solution& s = *solution;
  const engine::Clock time;
  const paper::IterationReport iterated =
      paper::iterate({s.scene, *s.tracer, s.elements, s.links}, *transfer,
                     well ? paper::kConvergedWell : paper::kConverged, [&](const paper::IterationReport& now) {
                       const double emitted = gray(now.emitted), left = gray(now.residual);
                       if (progress) progress->report("gather", emitted / std::max(emitted + left, 1e-30));
                       return !budget.up() || (well && left > paper::kConverged * emitted);
                     });
  lists.reset();
  residual = iterated.residual;
  s.report.counts.iterations += iterated.iterations;
  s.report.times.gather += time.seconds();
  return iterated.whole;
}

void Engine::State::iterateOverLists(std::span<const hierarchy::ElementId> changed) {
  Solution& s = *solution;
  const engine::Clock time;
  const paper::IterationReport iterated =
      lists->iterate({s.scene, *s.tracer, s.elements, s.links}, *transfer, changed, paper::kConvergedWell);
  DELTALUX_VALIDATED(lists->validate(s.elements, s.links));
  residual = iterated.residual;
  s.report.counts.iterations += iterated.iterations;
  s.report.times.gather += time.seconds();
}

}  // namespace deltalux
