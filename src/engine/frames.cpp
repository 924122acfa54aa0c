// Edits are taken in frame by frame, as far as the time of each goes (motion.hpp). [GD01 4.3]
#include <algorithm>
#include <utility>

#include "base/sort_unique.hpp"
#include "engine/state.hpp"
#include "hierarchy/pull.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux {

StepReport Engine::State::frame(double seconds) {
  constexpr double kPlanned = 0.92;  // of a frame: what is left keeps it in time where work takes longer than learned
  const engine::Clock time;
  const auto left = [&] { return kPlanned * seconds - time.seconds(); };
  Solution& s = *solution;
  StepReport step;
  const std::uint64_t traced = tracer().traced();
  if (byLines()) {
    frameOverLines(left, step);
    step.rays = tracer().traced() - traced;
    step.times.total = time.seconds();
    return step;
  }
  if (byPaper()) {  // the next update does it all
    takeIn(step);
    step.deferred = backlog.links.moved.size() + backlog.links.movedLights.size();
    step.times.total = time.seconds();
    return step;
  }
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
    if (tracing && !tracing->allWait() && !tracing->waiting().empty()) {  // rows get half of the time
      const double share = backlog.rows.empty() ? 0.0 : 0.5 * left();
      followInPart([&] { return left() - share; }, step);
    }
    ++backlog.framesSinceLinks;
    const bool links = backlog.linksWait() && (backlog.follow.seconds() < left() || backlog.linksAreDue());
    if (links) followWithLinks(step);
    if (!backlog.rows.empty()) followWithRows(left, step);
    if (links || relit) s.transfers.gatherDirect(s.elements);
    iterate(left, step);
  }
  countWaiting(step);
  step.particlesTotal = s.report.counts.particles;
  step.rays = tracer().traced() - traced;
  step.times.total = time.seconds();
  return step;
}

void Engine::State::frameOverLines(const SecondsLeft& left, StepReport& step) {
  Solution& s = *solution;
  const engine::SceneUpdate edits = pending;
  takeIn(step);
  const auto moves = [](const SceneChange::Moved& m) { return !m.before.empty() && !m.after.empty(); };
  if (s.memory && std::ranges::all_of(edits.moved, moves)) {  // what comes and goes, the update takes in
    groups.rebuild(tracer(), s.scene, edits.primitives());
    if (!lineMotion) lineMotion.emplace(s);
    if (!edits.empty()) lineMotion->note(s, edits, transfer ? &*transfer : nullptr);
    lineMotion->follow(s, left);
  }
  step.deferred = (lineMotion ? lineMotion->waiting() : 0) + lineEdits.moved.size() + lineEdits.dimmed.size() +
                  lineEdits.movedLights.size() + lineEdits.materials.size();
  step.staleW = lineMotion ? lineMotion->stale(s) * s.scene.metresPerUnit * s.scene.metresPerUnit : 0.0;
}

void Engine::State::countWaiting(StepReport& step) const {
  const Solution& s = *solution;
  step.deferred = backlog.links.moved.size() + backlog.links.movedLights.size();
  step.deferred += backlog.rows.size();
  double stale = (backlog.linksWait() ? engine::lightOn(s, backlog.links) : 0.0) + backlog.rows.stale();
  if (tracing && tracing->allWait()) {
    step.deferred += s.particles.paths();
    for (std::size_t path = 0; path < s.particles.paths(); ++path) stale += engine::deposited(s, *transfer, path);
  } else if (tracing) {
    step.deferred += tracing->waiting().size();
    for (const particles::ParticleTracing::Waiting& w : tracing->waiting()) stale += w.worth;
  }
  step.staleW = stale * s.scene.metresPerUnit * s.scene.metresPerUnit;
}

void Engine::State::followWithLinks(StepReport& step) {
  const engine::Clock time;
  const engine::SceneUpdate edits = std::exchange(backlog.links, {});
  Solution& s = *solution;
  const double stale = engine::lightOn(s, edits);
  Motion motion = leave(edits, step);
  engine::RowWork work = arriveInLight(edits, motion, false, step);
  backlog.rows.add(std::move(work), s.transfers, s.elements, s.links, stale);
  step.leavesChanged += renewRows(backlog.rows.work(), backlog.rows.urgent(), step).size();
  transfer.emplace(s.particles, s.elements, s.scene);
  backlog.framesSinceLinks = 0, backlog.linksFollowed = std::chrono::steady_clock::now();
  backlog.follow.learn(time.seconds());
}

void Engine::State::followWithRows(const SecondsLeft& left, StepReport& step) {
  constexpr std::size_t kFewest = 32;  // so that every frame gets on
  Solution& s = *solution;
  const engine::Clock time;
  const double seconds = left() - backlog.deposit.seconds();
  const auto fit = static_cast<std::size_t>(std::max(0.0, seconds) / backlog.row.seconds());
  const std::size_t before = backlog.rows.size(), elements = s.elements.size();
  const radiosity::ConcernedLeaves leaves = backlog.rows.take(std::max(kFewest, fit), s.elements);
  step.leavesChanged += renewRows(backlog.rows.work(), leaves, step).size();
  if (backlog.rows.empty()) backlog.rows = {};
  backlog.addSeen(s.scene);
  if (s.elements.size() != elements) transfer->follow(s.particles, {}, s.elements, s.scene);
  backlog.row.learn(time.seconds(), static_cast<double>(before - backlog.rows.size()));
}

void Engine::State::followInPart(const SecondsLeft& left, StepReport& step) {
  constexpr std::size_t kFewest = 256;  // so that every frame gets on
  Solution& s = *solution;
  const double time = left() - backlog.carry.seconds() - backlog.deposit.seconds();
  const auto fit = static_cast<std::size_t>(std::max(0.0, time) / backlog.path.seconds());
  const particles::ParticleUpdate followed = followWithParticles(std::max(kFewest, fit), step);
  const engine::Clock carrying;
  engine::TextureFlux textures(s);
  textures.takeOut(followed, *transfer);
  transfer->follow(s.particles, followed, s.elements, s.scene);
  carryTextures(textures, followed);
  backlog.carry.learn(carrying.seconds());
  step.times.particles += carrying.seconds();
}

void Engine::State::carryTextures(engine::TextureFlux& textures, const particles::ParticleUpdate& followed) {
  Solution& s = *solution;
  if (backlog.textures.empty()) backlog.textures = s.caustics.surfaces;
  textures.putIn(followed, *transfer);
  textures.apply(s.caustics, backlog.textures);
}

void Engine::State::iterate(const SecondsLeft& left, StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  transfer->apply(s.elements, scene::scalesOf(s.scene));
  hierarchy::pull(s.elements);
  backlog.deposit.learn(time.seconds());
  const double emitted = backlog.pass.seconds() < left() ? gray(directPower()) : 0.0;
  while (backlog.pass.seconds() < left()) {
    const engine::Clock passing;
    s.transfers.gatherIndirect(s.elements);
    transfer->apply(s.elements, scene::scalesOf(s.scene));
    unsettled = hierarchy::pull(s.elements);
    backlog.pass.learn(passing.seconds());
    ++s.report.counts.iterations;
    if (gray(unsettled) <= engine::kSettledRows * emitted) break;
  }
  step.times.gather += time.seconds();
}

void Engine::State::select(const std::string& object) {
  Solution& s = *solution;
  const std::vector<ObjectId> found = findObjects(s.scene, object);
  std::vector<PrimitiveId> primitives;
  for (const ObjectId id : found)
    for (const PrimitiveId p : primitivesOf(s.scene, id)) primitives.push_back(p);
  sortUnique(primitives);
  groups.separate(tracer(), s.scene, primitives);
  if (pending.empty() && !backlog.frames) prepareToFollow();
  if (!finished) return;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  Box box;
  for (const PrimitiveId p : primitives)
    if (const Box b = bounds(s.scene[p].shape); !b.empty()) box.extend(b);
  if (!tracing) return;
  s.particles.makeRoom();
  tracing->expectMotion(s.particles, box);
  s.report.memory.octree = tracing->watchBytes();
}

}  // namespace deltalux
