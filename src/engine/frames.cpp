// Edits are shown frame by frame, as far as the time of each goes. [GD01 4.3]
#include <algorithm>
#include <utility>

#include "base/sort_unique.hpp"
#include "engine/state.hpp"
#include "engine/tuning.hpp"

namespace deltalux {

StepReport Engine::State::frame(double seconds) {
  const engine::Clock time;
  StepReport step;
  const std::uint64_t traced = tracer().traced();
  const engine::SceneUpdate now = pending;
  takeIn(step);
  if (byLines())
    followWithShadows(
        now, [&] { return engine::tuning::kPlanned * seconds - time.seconds(); }, step);
  else
    followWithShareOfLinks(now, step);
  step.deferred += waiting.moved.size() + waiting.dimmed.size() + waiting.movedLights.size() + waiting.materials.size();
  step.rays = tracer().traced() - traced;
  step.times.total = time.seconds();
  return step;
}

void Engine::State::followWithShadows(const engine::SceneUpdate& now, const SecondsLeft& left, StepReport& step) {
  Solution& s = *solution;
  const auto moves = [](const SceneChange::Moved& m) { return !m.before.empty() && !m.after.empty(); };
  if (s.memory && std::ranges::all_of(now.moved, moves)) {  // what comes and goes, the update takes in
    groups.rebuild(tracer(), s.scene, now.primitives());
    if (!lineMotion) lineMotion.emplace(s);
    if (!now.empty()) lineMotion->note(s, now, transfer ? &*transfer : nullptr);
    lineMotion->follow(s, left);
  }
  step.deferred = lineMotion ? lineMotion->waiting() : 0;
  step.staleW = lineMotion ? lineMotion->stale(s) * s.scene.metresPerUnit * s.scene.metresPerUnit : 0.0;
}

void Engine::State::followWithShareOfLinks(const engine::SceneUpdate& now, StepReport& step) {
  if (waiting.empty() && !(incremental && incremental->waiting() > 0)) return;
  const bool alone = waiting.dimmed.empty() && waiting.movedLights.empty() && waiting.materials.empty() &&
                     engine::haveElements(solution->elements, solution->scene, waiting);
  if (alone) {
    updated = true;
    paperUpdate(engine::endToEnd(std::exchange(waiting, {})), solution->settings.reemittedShare, step, nullptr);
  } else {  // what lights do waits for the update, and all that comes after it
    groups.rebuild(tracer(), solution->scene, now.primitives());
  }
  step.deferred = incremental ? incremental->waiting() : 0;
}

void Engine::State::select(const std::string& object) {
  Solution& s = *solution;
  const std::vector<ObjectId> found = findObjects(s.scene, object);
  std::vector<PrimitiveId> primitives;
  for (const ObjectId id : found)
    for (const PrimitiveId p : primitivesOf(s.scene, id)) primitives.push_back(p);
  sortUnique(primitives);
  groups.separate(tracer(), s.scene, primitives);
  if (pending.empty() && waiting.empty()) prepareToFollow();
  if (!finished) return;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  Box box;
  for (const PrimitiveId p : primitives)
    if (const Box b = bounds(s.scene[p].shape); !b.empty()) box.extend(b);
  if (!tracing) return;
  s.particles.makeRoom();
  if (byLines()) {
    tracing->expectMotion(s.particles, box);
    s.report.memory.octree = tracing->watchBytes();
  } else {
    if (!incremental) incremental.emplace(s.scene, *tracing);
    incremental->select(s.particles, primitives);
    s.report.memory.octree = incremental->octreeBytes();
  }
}

}  // namespace deltalux
