// Edits are taken in frame by frame, as far as the time of each goes (motion.hpp). [GD01 4.3]
#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "engine/state.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

StepReport Engine::State::frame(double seconds) {
  const Clock time;
  const auto left = [&] { return seconds - time.seconds(); };
  Solution& s = *solution;
  StepReport step;
  constexpr double kLikely = 0.02;  // of the time of a solve
  if (!backlog.follow.known()) backlog.follow.learn(kLikely * s.report.times.total);
  constexpr double kMostGapsInMotion = 4;  // closing them takes longer than a frame
  if (gapsAreMany(kMostGapsInMotion)) {    // what the paths were, textures have to see first
    if (tracing && transfer) followWithTextures(step);
    closeGaps();
  }
  settling.reset();
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  const bool relit = !pending.dimmed.empty();
  takeIn(step, true);
  backlog.frames = true;
  if (!backlog.afresh) {
    if (tracing && !tracing->allWait() && !tracing->waiting().empty()) followInPart(left, step);
    const bool links = backlog.linksWait() && backlog.follow.seconds() < left();
    if (links) followWithLinks(step);
    if (links || relit) s.transfers.gatherDirect(s.elements);
    iterate(left, step);
  }
  countWaiting(step);
  step.particlesTotal = s.report.counts.particles;
  step.times.total = time.seconds();
  return step;
}

void Engine::State::countWaiting(StepReport& step) const {
  const Solution& s = *solution;
  step.deferred = backlog.links.moved.size() + backlog.links.movedLights.size();
  double stale = backlog.linksWait() ? lightOn(s, backlog.links) : 0.0;
  if (tracing && tracing->allWait()) {
    step.deferred += s.particles.paths();
    for (std::size_t path = 0; path < s.particles.paths(); ++path) stale += deposited(s, *transfer, path);
  } else if (tracing) {
    step.deferred += tracing->waiting().size();
    for (const ParticleTracing::Waiting& w : tracing->waiting()) stale += w.worth;
  }
  step.staleW = stale * s.scene.metresPerUnit * s.scene.metresPerUnit;
}

void Engine::State::followWithLinks(StepReport& step) {
  const Clock time;
  const SceneUpdate edits = std::exchange(backlog.links, {});
  Motion motion = leave(edits, step);
  arriveInLight(edits, motion, false, step);
  transfer.emplace(solution->particles, solution->elements, solution->scene);
  backlog.follow.learn(time.seconds());
}

void Engine::State::followInPart(const SecondsLeft& left, StepReport& step) {
  constexpr std::size_t kFewest = 256;  // so that every frame gets on
  Solution& s = *solution;
  const double time = left() - backlog.carry.seconds() - backlog.deposit.seconds();
  const auto fit = static_cast<std::size_t>(std::max(0.0, time) / backlog.path.seconds());
  const ParticleUpdate followed = followWithParticles(std::max(kFewest, fit), step);
  const Clock carrying;
  TextureFlux textures(s);
  textures.takeOut(followed, *transfer);
  transfer->follow(s.particles, followed, s.elements, s.scene);
  carryTextures(textures, followed);
  backlog.carry.learn(carrying.seconds());
  step.times.particles += carrying.seconds();
}

void Engine::State::carryTextures(TextureFlux& textures, const ParticleUpdate& followed) {
  Solution& s = *solution;
  if (backlog.textures.empty()) backlog.textures = s.caustics.surfaces;
  textures.putIn(followed, *transfer);
  textures.apply(s.caustics, backlog.textures);
}

void Engine::State::iterate(const SecondsLeft& left, StepReport& step) {
  Solution& s = *solution;
  const Clock time;
  transfer->apply(s.elements, s.scene);
  pull(s.elements);
  backlog.deposit.learn(time.seconds());
  const double emitted = backlog.pass.seconds() < left() ? gray(directPower()) : 0.0;
  while (backlog.pass.seconds() < left()) {
    const Clock passing;
    s.transfers.gatherIndirect(s.elements);
    transfer->apply(s.elements, s.scene);
    unsettled = pull(s.elements);
    backlog.pass.learn(passing.seconds());
    ++s.report.counts.iterations;
    if (gray(unsettled) <= kSettledRows * emitted) break;
  }
  step.times.gather += time.seconds();
}

void Engine::State::select(const std::string& object) {
  Solution& s = *solution;
  const std::vector<ObjectId> found = findObjects(s.scene, object);
  std::vector<PrimitiveId> primitives;
  for (const ObjectId id : found)
    for (const PrimitiveId p : primitivesOf(s.scene, id)) primitives.push_back(p);
  std::sort(primitives.begin(), primitives.end());
  primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
  groups.separate(tracer(), s.scene, primitives);
  if (pending.empty() && !backlog.frames) prepareToFollow();
  if (!finished) return;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  Box box;
  for (const PrimitiveId p : primitives)
    if (const Box b = bounds(s.scene[p].shape); !b.empty()) box.extend(b);
  if (tracing) tracing->expectMotion(s.particles, box);
}

}  // namespace deltalux
