// Edits are taken in whole: what a fresh solve would make of the edited scene, from the solution there is. [GD01 4, 5]
#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "base/tuning.hpp"
#include "engine/particle_settings.hpp"
#include "engine/state.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/pull.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux {

Restore Engine::State::apply(const Edit& edit) {
  if (pending.empty() && waiting.empty()) prepareToFollow();
  Restore restore = engine::applyInto(pending, solution->scene, edit);
  standBy();
  return restore;
}

void Engine::State::standBy() {
  if (!solution->settings.byLight) return;
  for (Light& light : solution->scene.lights) light.standby = true;
}

void Engine::State::prepareToFollow() {
  Solution& s = *solution;
  if (!finished || (byLines() && (!s.memory || s.settings.diffuseOnly))) return;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  if (s.settings.diffuseOnly) return;
  if (!tracing) tracing.emplace(s.scene, *s.tracer, engine::particleSettings(s.settings));
  if (byLines() && !textureUpdate && s.settings.causticTextures)
    textureUpdate.emplace(caustics::TextureUpdate::Parts{s.scene, s.elements, s.particles}, *transfer,
                          s.settings.error);
}

StepReport Engine::State::update(Progress* progress) {
  const engine::Clock time;
  StepReport step;
  std::uint64_t traced = tracer().traced();
  takeIn(step);
  updated = true;
  const engine::SceneUpdate taken = engine::endToEnd(std::exchange(waiting, {}));
  const Solution& s = *solution;
  if (byLines() || !engine::haveElements(s.elements, s.scene, taken) || outshines(taken)) {
    lineMotion.reset(), counts = {};
    if (const auto weights = weightsAlone(taken)) {
      dim(taken, [&] { addUp(*solution, *weights); });
    } else if (const auto dimming = dimmingAlone(taken)) {
      dim(taken, [&] { relightOverLines(*dimming); });
    } else {
      recall(taken);
      if (!known) traced = 0;  // by a tracer of its own
      solveAfresh(progress);
      freed.giveBack();
    }
    step.leavesChanged = counts.leavesChanged, step.texturesRebuilt = counts.texturesRebuilt;
    step.particlesRetraced = counts.particlesRetraced, step.particlesTotal = s.particles.arrived();
    step.times = s.report.times;
    step.times.particles += counts.times.particles;
  } else {
    paperUpdate(taken, 1.0, step, progress);
  }
  step.rays = tracer().traced() - traced;
  step.times.total = time.seconds();
  return step;
}

void Engine::State::takeIn(StepReport& step) {
  step.op = pending.op, step.object = pending.subject;
  waiting.add(std::exchange(pending, {}));
}

std::optional<engine::Dimming> Engine::State::dimmingAlone(const engine::SceneUpdate& edits) const {
  const Solution& s = *solution;
  if (!byLines() || !finished || !s.memory || !edits.dimsAlone() || s.memory->nominal != scene::nominalScales(s.scene))
    return {};
  const direct::Skies skies(s.scene);
  if (skies.key() != s.memory->sky.skies) return {};
  return engine::Dimming::of(s.scene, skies);
}

std::optional<std::vector<Rgb>> Engine::State::weightsAlone(const engine::SceneUpdate& edits) const {
  const Solution& s = *solution;
  if (!finished || s.columns.empty() || !edits.dimsAlone()) return {};
  return weightsOf(s.columns, s.scene);
}

void Engine::State::dim(const engine::SceneUpdate& edits, const std::function<void()>& light) {
  Solution& s = *solution;
  const engine::Clock time;
  for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.dimmed))
    hierarchy::setEmission(s.elements, s.scene, e);
  newPaths.reset();
  if (tracing) newPaths = followWithParticles(edits.whole, counts);
  light();
  s.report.times = {};
  s.report.times.gather = time.seconds();
  followTextures(counts);
  counted = false;
}

void Engine::State::relightOverLines(const engine::Dimming& dimming) {
  Solution& s = *solution;
  if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
  transfer->apply(s.elements, scene::scalesOf(s.scene));
  s.report.counts.iterations = 0;
  const hierarchy::LeafTable leaves(s.elements);
  const SolveMemory& memory = *s.memory;
  engine::relight(s, leaves, *memory.exchange, engine::lampsOf(memory.samples, memory.dim, leaves), memory.sky, dimming,
                  deltalux::tuning::kConverged);
  hierarchy::pull(s.elements);
}

void Engine::State::recall(const engine::SceneUpdate& edits) {
  Solution& s = *solution;
  known.reset(), newPaths.reset();
  const std::shared_ptr<SolveMemory> before = std::exchange(s.memory, {});
  if (before.use_count() != 1 || !finished) return;  // what others hold too is theirs
  if (!tracing && !s.settings.diffuseOnly) return;   // nobody has followed the particles from the start
  const std::vector<char> plain = lines::SurfaceResponses(s.scene, !s.settings.diffuseOnly).plain();
  for (const MaterialId m : edits.materials)  // lines go on as others say
    if (m.index() >= before->plain.size() || !before->plain[m.index()] || !plain[m.index()]) return;
  const bool lampMoves = std::ranges::any_of(
      edits.moved, [&](const SceneChange::Moved& m) { return sendsLight(s.scene.materialOf(m.primitive)); });
  groups.rebuild(tracer(), s.scene, edits.primitives());
  if (tracing) {
    newPaths = followWithParticles(edits.whole, counts);
    const bool added = std::ranges::any_of(edits.moved, [](const SceneChange::Moved& m) { return m.before.empty(); });
    if (newPaths->all || added) newPaths.reset();
    if (gapsAreMany()) closeGaps(), newPaths.reset();
  }
  engine::EditedScene edited;
  edited.space = change::MovedSpace(s.scene, edits.moved);
  edited.moved = edits.primitives(), edited.painted = edits.materials;
  const std::vector<Rgb> nominal = scene::nominalScales(s.scene);
  edited.movedLights = engine::lightsThatMoved(s.scene, edits);
  const auto black = [](const Rgb& scale) { return isBlack(scale); };
  edited.sameLights = std::ranges::equal(nominal, before->nominal, {}, black, black);
  edited.lightsStay = !lampMoves && edited.sameLights &&
                      std::ranges::none_of(edited.movedLights, [](char moved) { return moved != 0; });
  edited.lightsSame = edited.sameLights && nominal == before->nominal;
  for (const std::vector<LightId>* some : {&edits.movedLights, &edits.dimmed})
    edited.relit.insert(edited.relit.end(), some->begin(), some->end());
  edited.stands = engine::haveElements(s.elements, s.scene, edits) &&
                  std::ranges::none_of(edits.moved,
                                       [](const SceneChange::Moved& m) { return m.before.empty() || m.after.empty(); });
  edited.retraced = newPaths ? &*newPaths : nullptr;
  known.emplace(std::move(*before), s, std::move(edited), std::exchange(transfer, {}));
}

particles::ParticleUpdate Engine::State::followWithParticles(const SceneChange& change, StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  particles::ParticleUpdate followed = tracing->follow(s.particles, change);
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  step.particlesRetraced = followed.all ? s.particles.arrived() : followed.particles;
  step.times.particles += time.seconds();
  return followed;
}

bool Engine::State::gapsAreMany() const {
  const particles::Particles& p = solution->particles;
  std::size_t used = 0;
  for (const particles::PathRange& r : p.range) used += r.vertices;
  return p.vertices.size() > 2 * used;
}

void Engine::State::closeGaps() {
  solution->particles.compact();
  transfer.reset(), textureUpdate.reset();
}

}  // namespace deltalux
