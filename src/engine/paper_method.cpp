// Solves and updates over links alone (paper/solve.hpp, paper/update.hpp): their stages in order.
#include <deltalux/error.hpp>
#include <utility>

#include "base/check.hpp"
#include "engine/state.hpp"
#include "paper/update.hpp"

namespace deltalux {

void Engine::State::paperRound(Progress* progress) {
  Solution& s = *solution;
  paper::OracleSettings oracle = linksJudged();
  const double least = oracle.error;
  oracle.error = std::max(nextError, least);
  const bool last = oracle.error <= least;
  const paper::RefineReport refined = refineLinks(oracle, progress);

  subdivideForParticles();
  const engine::Clock placing;
  transfer.emplace(s.particles, s.elements, s.scene);
  s.report.times.particles += placing.seconds();

  nextError = paper::nextError(oracle.error, least);
  if (budget.limited()) {
    const double left = budget.left() - engine::kEndingTime * budget.seconds();
    nextError = budget.reach(paper::LinkErrors(s.links, s.elements, oracle), oracle.error, nextError, left);
  }
  finished = last || refined.stopped || !(nextError < oracle.error);
  const bool settled = settleOverLinks(finished, progress);
  const bool limited = budget.limited();
  if (finished) {
    s.sampledScale.clear();
    for (const Light& light : s.scene.lights) s.sampledScale.push_back(light.scale);
    makeTextures();
  }
  count();
  if (finished) budget = engine::TimeBudget(0);  // updates take what time they need
  if (!limited) prepareToFollow();               // or the first edit does
  s.report.converged = settled && last && !refined.stopped && !curtailed;
}

bool Engine::State::settleOverLinks(bool well, Progress* progress) {
  Solution& s = *solution;
  const engine::Clock time;
  const paper::Settled settled =
      paper::settle({s.scene, *s.tracer, s.elements, s.links}, *transfer, well ? paper::kSettledWell : paper::kSettled,
                    [&](const paper::Settled& now) {
                      const double emitted = gray(now.emitted), left = gray(now.unsettled);
                      if (progress) progress->report("gather", emitted / std::max(emitted + left, 1e-30));
                      return !budget.up();
                    });
  unsettled = settled.unsettled;
  s.report.counts.iterations += settled.iterations;
  s.report.times.gather += time.seconds();
  return settled.whole;
}

void Engine::State::paperUpdate(StepReport& step, Progress* progress) {
  Solution& s = *solution;
  const paper::Parts parts{s.scene, *s.tracer, s.elements, s.links};
  const engine::SceneUpdate edits = std::exchange(backlog.links, {});
  const engine::Clock leaving;
  paper::Motion motion = paper::leave(parts, edits.moved, edits.movedLights, linksJudged());
  step.times.visibility = leaving.seconds();

  particles::ParticleUpdate followed;
  if (tracing) followed = followWithParticles(tracing->waiting().size(), step);
  subdivideWhereParticlesLanded(step);
  engine::Growth growth = grow(edits, backlog.landed, step);
  const std::vector<hierarchy::ElementId> reflecting = std::exchange(backlog.reflecting, {});
  growth.woken.insert(growth.woken.end(), reflecting.begin(), reflecting.end());
  if (!motion.marks.changes.empty() || !growth.empty()) judgeAnew(motion, growth, step);

  engine::LightChanges light;
  light.rows = engine::leavesBelow(s.elements, growth), light.painted = std::exchange(backlog.painted, {});
  placeParticles(followed, light, step);
  spreadParticlesAnew(light);
  const bool relit = std::exchange(backlog.dimmed, false) || !edits.movedLights.empty() || !light.painted.empty();
  backlog.frames = false, backlog.rescaled.clear();
  const double before = s.report.times.gather;
  settleOverLinks(true, progress);
  if (relit && refineByNewLight(progress)) settleOverLinks(true, progress);
  step.times.gather = s.report.times.gather - before;
  step.leavesChanged = s.report.counts.leafElements;
  followWithTextures(step);
  if (gapsAreMany()) closeGaps();
  counted = false;
}

paper::OracleSettings Engine::State::linksJudged() const {
  if (byPaper()) return paper::judgedFor(solution->settings.error);
  paper::OracleSettings oracle;
  oracle.error = solution->settings.error * engine::kLastError;
  return oracle;
}

std::vector<hierarchy::LinkId> Engine::State::judgeAnew(paper::Motion& motion, const engine::Growth& growth,
                                                        StepReport& step) {
  Solution& s = *solution;
  const paper::Parts parts{s.scene, *s.tracer, s.elements, s.links};
  const engine::Clock time;
  paper::arrive(parts, motion, {growth.root, growth.woken}, linksJudged());
  if (!growth.empty()) motion.all.findHidden(s.elements, s.scene, growth.root);
  step.linksVisited = motion.marks.visited;
  step.times.visibility += time.seconds();
  const engine::Clock refining;
  std::vector<hierarchy::LinkId> changed;
  const paper::RefineReport refined = paper::follow(parts, motion, linksJudged(), changed);
  s.report.counts.raysVisibility += refined.rays;
  step.linksChanged = changed.size();
  step.times.refine = refining.seconds();
  return changed;
}

/// Links that err by more than they may where more light has come; returns whether there are more now.
bool Engine::State::refineByNewLight(Progress* progress) {
  Solution& s = *solution;
  const std::size_t elements = s.elements.size();
  const paper::RefineReport refined = refineLinks(linksJudged(), progress);
  if (s.elements.size() != elements) transfer->follow(s.particles, {}, s.elements, s.scene);
  return refined.created > 0;
}

}  // namespace deltalux
