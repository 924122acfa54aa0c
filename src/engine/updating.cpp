// Edits are taken in whole: what a fresh solve would make of the edited scene, from the solution there is. [GD01 4, 5]
#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "base/sort_unique.hpp"
#include "engine/particle_count.hpp"
#include "engine/state.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/pull.hpp"
#include "lines/tuning.hpp"
#include "radiosity/direct_senders.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux {

namespace {
std::size_t countDistinct(std::vector<hierarchy::ElementId> ids) {
  sortUnique(ids);
  return ids.size();
}
}  // namespace

StepReport Engine::State::update(Progress* progress) {
  const engine::Clock time;
  StepReport step;
  const std::uint64_t traced = tracer().traced();
  takeIn(step);
  updated = true;
  if (backlog.afresh) {
    lineMotion.reset(), counts = {};
    const engine::SceneUpdate edits = engine::endToEnd(std::exchange(lineEdits, {}));
    std::uint64_t before = traced;
    if (onlyDims(edits)) {
      relightOverLines(edits);
    } else {
      recall(edits);
      if (!known) before = 0;  // by a tracer of its own
      solveAfresh(progress);
    }
    step.leavesChanged = counts.leavesChanged, step.texturesRebuilt = counts.texturesRebuilt;
    step.particlesRetraced = counts.particlesRetraced, step.particlesTotal = solution->particles.arrived();
    step.rays = tracer().traced() - before;
    step.times = solution->report.times;
    step.times.particles += counts.times.particles;
    step.times.total = time.seconds();
    return step;
  }
  if (byPaper()) {
    paperUpdate(step, progress);
    step.rays = tracer().traced() - traced;
    step.times.total = time.seconds();
    return step;
  }
  const std::vector<hierarchy::ElementId> waited = renewWaitingRows(step);
  const engine::SceneUpdate edits = std::exchange(backlog.links, {});
  Motion motion = leave(edits, step);
  particles::ParticleUpdate followed;
  if (tracing) followed = followWithParticles(tracing->waiting().size(), step);
  const bool split = subdivideWhereParticlesLanded(step);
  const engine::RowWork work = arriveInLight(edits, motion, split, step);
  for (const auto& rows : {renewRows(work, work.leaves, step), waited})
    motion.light.rows.insert(motion.light.rows.end(), rows.begin(), rows.end());
  // Frames may have found origins on what had moved where its elements did not stand yet.
  if (std::exchange(backlog.frames, false)) transfer.reset();
  placeParticles(followed, motion.light, step);
  motion.light.lights = std::exchange(backlog.dimmed, false);
  motion.light.painted = std::exchange(backlog.painted, {});
  const std::vector<hierarchy::ElementId> rescaled = std::exchange(backlog.rescaled, {});
  motion.light.rows.insert(motion.light.rows.end(), rescaled.begin(), rescaled.end());
  spreadParticlesAnew(motion.light);
  step.leavesChanged = countDistinct(motion.light.rows);
  const engine::Clock gathering;
  settleAfter(motion.light, progress);
  step.times.gather += gathering.seconds();
  followWithTextures(step);
  if (gapsAreMany()) closeGaps();
  counted = false;
  step.rays = tracer().traced() - traced;
  step.times.total = time.seconds();
  return step;
}

engine::RowWork Engine::State::arriveInLight(const engine::SceneUpdate& edits, Motion& motion, bool split,
                                             StepReport& step) {
  engine::Growth growth = grow(edits, backlog.landed, step);
  const std::vector<hierarchy::ElementId> reflecting = std::exchange(backlog.reflecting, {});
  growth.woken.insert(growth.woken.end(), reflecting.begin(), reflecting.end());
  motion.light.rows = engine::leavesBelow(solution->elements, growth);
  if (!split && motion.marks.changes.empty() && growth.empty()) return {};
  return arrive(motion, growth, step);
}

void Engine::State::takeIn(StepReport& step, bool inMotion) {
  const engine::SceneUpdate edits = std::exchange(pending, {});
  step.op = edits.op, step.object = edits.subject;
  if (byLines()) lineEdits.add(edits);
  backlog.afresh |= byLines() || !engine::haveElements(solution->elements, solution->scene, edits) || outshines(edits);
  if (backlog.afresh) return;
  backlog.dimmed |= !edits.dimmed.empty();
  const std::vector<hierarchy::ElementId> reflecting = relight(edits);
  backlog.reflecting.insert(backlog.reflecting.end(), reflecting.begin(), reflecting.end());
  groups.rebuild(tracer(), solution->scene, edits.primitives());
  backlog.add(edits);
  if (!tracing) return;
  const engine::Clock time;
  particles::ParticleTracing::Worth worth;
  if (inMotion) worth = [&](std::size_t path) { return engine::deposited(*solution, *transfer, path); };
  tracing->note(solution->particles, edits.whole, worth);
  step.times.particles += time.seconds();
}

bool Engine::State::onlyDims(const engine::SceneUpdate& edits) const {
  const Solution& s = *solution;
  return byLines() && finished && s.memory && edits.moved.empty() && edits.movedLights.empty() &&
         edits.materials.empty() && s.memory->nominal == scene::nominalScales(s.scene) &&
         s.memory->sky.skies == direct::Skies(s.scene).key();
}

void Engine::State::relightOverLines(const engine::SceneUpdate& edits) {
  Solution& s = *solution;
  const engine::Clock time;
  backlog = {};
  for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.dimmed))
    hierarchy::setEmission(s.elements, s.scene, e);
  newPaths.reset();
  if (tracing) newPaths = tracing->follow(s.particles, edits.whole);
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  transfer->apply(s.elements, scene::scalesOf(s.scene));
  s.report.counts.iterations = 0;
  engine::relight(s, *s.memory->exchange,
                  engine::lampsOf(s.memory->samples, s.memory->dim, hierarchy::LeafTable(s.elements)), s.memory->sky,
                  engine::Dimming::of(s.scene, direct::Skies(s.scene)), lines::tuning::kConvergedAgain);
  hierarchy::pull(s.elements);
  s.report.error = engine::estimateError(s);
  s.report.times = {};
  s.report.times.gather = time.seconds();
  followTextures();
  countLight();
}

void Engine::State::recall(const engine::SceneUpdate& edits) {
  Solution& s = *solution;
  known.reset(), newPaths.reset();
  const std::shared_ptr<SolveMemory> before = std::exchange(s.memory, {});
  if (before.use_count() != 1 || !finished) return;  // what others hold too is theirs
  if (!tracing && !s.settings.diffuseOnly) return;   // nobody has newPaths the particles from the start
  const std::vector<char> plain = lines::SurfaceResponses(s.scene, !s.settings.diffuseOnly).plain();
  for (const MaterialId m : edits.materials)  // lines go on as others say
    if (m.index() >= before->plain.size() || !before->plain[m.index()] || !plain[m.index()]) return;
  const bool lampMoves = std::ranges::any_of(
      edits.moved, [&](const SceneChange::Moved& m) { return sendsLight(s.scene.materialOf(m.primitive)); });
  groups.rebuild(tracer(), s.scene, edits.primitives());
  if (tracing) {
    const engine::Clock following;
    newPaths = tracing->follow(s.particles, edits.whole);
    counts.times.particles = following.seconds();
    counts.particlesRetraced = newPaths->all ? s.particles.arrived() : newPaths->particles;
    DELTALUX_VALIDATED(validate(s.particles, s.scene));
    const bool added = std::ranges::any_of(edits.moved, [](const SceneChange::Moved& m) { return m.before.empty(); });
    if (newPaths->all || added) newPaths.reset();
    if (gapsAreMany()) closeGaps(), newPaths.reset();
  }
  engine::KnownSolve::Lights lights;
  const std::vector<Rgb> nominal = scene::nominalScales(s.scene);
  lights.stay = edits.movedLights.empty() && !lampMoves &&
                std::ranges::equal(
                    nominal, before->nominal, {}, [](const Rgb& scale) { return isBlack(scale); },
                    [](const Rgb& scale) { return isBlack(scale); });
  lights.same = lights.stay && nominal == before->nominal;
  known.emplace(std::move(*before), s, change::MovedSpace(s.scene, edits.moved), lights);
}

bool Engine::State::outshines(const engine::SceneUpdate& edits) const {
  const Solution& s = *solution;
  return std::any_of(edits.dimmed.begin(), edits.dimmed.end(), [&](LightId light) {
    return light.index() >= s.sampledScale.size() ||  // it was not there
           gray(s.scene[light].scale) > radiosity::kBrighter * gray(s.sampledScale[light.index()]);
  });
}

engine::Growth Engine::State::grow(const engine::SceneUpdate& edits, const particles::ParticleUpdate& followed,
                                   StepReport& step) {
  const engine::Clock time;
  const engine::Growth growth = engine::growInLight(*solution, edits, followed);
  DELTALUX_VALIDATED(validate(solution->elements));
  step.times.hierarchy = time.seconds();
  return growth;
}

Restore Engine::State::apply(const Edit& edit) {
  if (pending.empty() && !backlog.frames) prepareToFollow();
  return engine::applyInto(pending, solution->scene, edit);
}

void Engine::State::prepareToFollow() {
  Solution& s = *solution;
  if (!finished) return;
  if (byLines()) {
    if (!s.memory || s.settings.diffuseOnly) return;
    if (!tracing) tracing.emplace(s.scene, *s.tracer, engine::lineParticles(s));
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    if (!upkeep && s.settings.causticTextures)
      upkeep.emplace(caustics::TextureUpkeep::Parts{s.scene, s.elements, s.particles}, *transfer, s.settings.error);
    return;
  }
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  if (!settling && !byPaper())
    settling.emplace(engine::LightSettling::Parts{s.scene, s.transfers, *transfer}, s.elements);
  if (s.settings.diffuseOnly) return;
  if (!tracing)
    tracing.emplace(s.scene, *s.tracer,
                    particles::ParticleSettings{engine::particleCount(s.settings), s.settings.seed});
  if (upkeep || !s.settings.causticTextures) return;
  upkeep.emplace(caustics::TextureUpkeep::Parts{s.scene, s.elements, s.particles}, *transfer, s.settings.error);
}

std::vector<hierarchy::ElementId> Engine::State::relight(const engine::SceneUpdate& edits) {
  Solution& s = *solution;
  std::vector<hierarchy::ElementId> reflecting;
  for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.dimmed))
    hierarchy::setEmission(s.elements, s.scene, e);
  for (const LightId light : edits.movedLights)
    if (Rgb& sampled = s.sampledScale[light.index()]; gray(s.scene[light].scale) > gray(sampled))
      sampled = s.scene[light].scale;
  if (edits.materials.empty()) return reflecting;
  const std::size_t earlier = backlog.painted.size();
  for (const hierarchy::ElementId e : engine::paintedSurfaces(s.elements, s.scene, edits.materials)) {
    backlog.painted.push_back(e);
    const hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    const bool wasBlack = isBlack(l.rho) && isBlack(l.tau);
    hierarchy::setReflectance(s.elements, s.scene, e);
    if (wasBlack && !(isBlack(l.rho) && isBlack(l.tau))) reflecting.push_back(e);
  }
  s.transfers.followReflectance(s.elements, std::span(backlog.painted).subspan(earlier), backlog.rescaled);
  return reflecting;
}

Engine::State::Motion Engine::State::leave(const engine::SceneUpdate& edits, StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  Motion motion{paper::leave({s.scene, *s.tracer, s.elements, s.links}, edits.moved, edits.movedLights, linksJudged()),
                {}};
  if (!edits.movedLights.empty()) radiosity::creditLights(s.elements);
  step.times.visibility = time.seconds();
  return motion;
}

engine::RowWork Engine::State::arrive(Motion& motion, const engine::Growth& growth, StepReport& step) {
  Solution& s = *solution;
  engine::RowWork work;
  work.changed = judgeAnew(motion, growth, step);
  const engine::Clock gathering;
  work.leaves = s.transfers.concerned(s.elements, s.links, work.changed, motion.all);
  work.marks = std::move(motion.marks), work.space = std::move(motion.all);
  step.leavesExamined = std::max(work.leaves.byLights.size(), work.leaves.byLeaves.size());
  step.times.gather += gathering.seconds();
  return work;
}

std::vector<hierarchy::ElementId> Engine::State::renewRows(const engine::RowWork& work,
                                                           const radiosity::ConcernedLeaves& leaves, StepReport& step) {
  if (leaves.byLights.empty() && leaves.byLeaves.empty()) return {};
  Solution& s = *solution;
  const engine::Clock time;
  radiosity::LeafUpdateReport rows = s.transfers.update(s.elements, s.links, s.scene, *s.tracer, leafSettings(),
                                                        work.marks, work.changed, work.space, leaves);
  DELTALUX_VALIDATED(s.transfers.validate(s.elements, s.links));
  s.report.counts.raysVisibility += rows.rays;
  step.times.gather += time.seconds();
  return std::move(rows.leaves);
}

std::vector<hierarchy::ElementId> Engine::State::renewWaitingRows(StepReport& step) {
  engine::RowQueue waiting = std::exchange(backlog.rows, {});
  return renewRows(waiting.work(), waiting.take(waiting.size(), solution->elements), step);
}

void Engine::State::settleAfter(const engine::LightChanges& changes, Progress* progress) {
  if (settling)
    unsettled = RgbSum(settleOver(changes));
  else
    settleRows(progress);
}

double Engine::State::settleOver(const engine::LightChanges& changes) {
  Solution& s = *solution;
  return settling->settle({s.scene, s.transfers, *transfer}, s.elements, changes, engine::kMissed * gray(directPower()),
                          engine::kMaxRowIterations, s.report.counts.iterations);
}

}  // namespace deltalux
