// Updates over links (paper/update.hpp): their stages in order. [GD01 4, 5]
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "engine/state.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"
#include "paper/texture_update.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/side_index.hpp"
#include "scene/tuning.hpp"

namespace deltalux {

void Engine::State::paperUpdate(const engine::SceneUpdate& edits, double share, StepReport& step, Progress* progress) {
  Solution& s = *solution;
  const double gathered = s.report.times.gather, textured = s.report.times.textures;
  if (!lists) lists.emplace(s.elements);
  std::vector<hierarchy::ElementId> painted, reflecting;
  relight(edits, painted, reflecting);
  groups.rebuild(tracer(), s.scene, edits.primitives());

  const engine::Clock leaving;
  paper::LinkMarks marks = paper::leave({s.scene, *s.tracer, s.elements, s.links}, edits.moved, edits.movedLights);
  step.times.visibility = leaving.seconds();

  particles::ParticleUpdate followed;
  if (tracing) followed = reemitParticles(edits.whole, share, step), countParticles();
  step.particlesTotal = s.particles.arrived();
  const engine::Clock splitting;
  subdivideForDeposits(followed);
  step.times.particles += splitting.seconds();
  engine::Growth growth = grow(edits, followed, step);
  growth.reactivated.insert(growth.reactivated.end(), reflecting.begin(), reflecting.end());
  evaluateAgain(std::move(marks), growth, step);

  std::vector<hierarchy::ElementId> changed = engine::leavesBelow(s.elements, growth);
  changed.insert(changed.end(), painted.begin(), painted.end());
  const engine::Clock placing;
  placeParticles(followed, changed);
  step.times.particles += placing.seconds();
  const bool relit = !edits.dimmed.empty() || !edits.movedLights.empty() || !painted.empty();
  if (relit) {  // all light is another
    iterateOverLinks(true, progress);
    if (refineByNewLight(progress)) iterateOverLinks(true, progress);
  } else {
    const std::vector<hierarchy::ElementId> moved = hierarchy::elementsOf(s.elements, edits.primitives());
    changed.insert(changed.end(), moved.begin(), moved.end());
    iterateOverLists(changed);
  }
  step.times.gather = s.report.times.gather - gathered;
  step.leavesChanged = s.report.counts.leafElements;

  if (followed.all || relit)  // particles of one texture may have been dimmed unlike others
    followTextures(step);
  else
    followPaperTextures(followed, step);
  step.times.textures = s.report.times.textures - textured;
  if (gapsAreMany()) closeGaps();
  counted = false;
}

void Engine::State::followPaperTextures(const particles::ParticleUpdate& followed, StepReport& step) {
  Solution& s = *solution;
  if (!s.settings.causticTextures) return;
  const engine::Clock time;
  step.texturesRebuilt =
      paper::followTextures(s.caustics, s.scene, s.elements, s.particles, followed, s.settings.error);
  DELTALUX_VALIDATED(validate(s.caustics));
  s.report.times.textures += time.seconds();
  countTextures();
}

particles::ParticleUpdate Engine::State::reemitParticles(const SceneChange& change, double share, StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  if (!incremental) incremental.emplace(s.scene, *tracing);
  particles::ParticleUpdate followed = incremental->follow(s.particles, change, share);
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  step.particlesRetraced = followed.all ? s.particles.arrived() : followed.particles;
  s.report.memory.octree = incremental->octreeBytes();
  step.times.particles += time.seconds();
  return followed;
}

bool Engine::State::outshines(const engine::SceneUpdate& edits) const {
  const Solution& s = *solution;
  return std::any_of(edits.dimmed.begin(), edits.dimmed.end(), [&](LightId light) {
    return light.index() >= s.sampledScale.size() ||  // it was not there
           gray(s.scene[light].scale) >
               std::ldexp(1.0, scene::tuning::kNominalOctaves) * gray(s.sampledScale[light.index()]);
  });
}

void Engine::State::relight(const engine::SceneUpdate& edits, std::vector<hierarchy::ElementId>& painted,
                            std::vector<hierarchy::ElementId>& reflecting) {
  Solution& s = *solution;
  for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.dimmed))
    hierarchy::setEmission(s.elements, s.scene, e);
  for (const LightId light : edits.movedLights)
    if (Rgb& sampled = s.sampledScale[light.index()]; gray(s.scene[light].scale) > gray(sampled))
      sampled = s.scene[light].scale;
  if (edits.materials.empty()) return;
  painted = engine::paintedSurfaces(s.elements, s.scene, edits.materials);
  for (const hierarchy::ElementId e : painted) {
    const hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    const bool wasBlack = isBlack(l.rho) && isBlack(l.tau);
    hierarchy::setReflectance(s.elements, s.scene, e);
    if (wasBlack && !(isBlack(l.rho) && isBlack(l.tau))) reflecting.push_back(e);
  }
}

void Engine::State::subdivideForDeposits(const particles::ParticleUpdate& deposited) {
  Solution& s = *solution;
  if (deposited.paths.empty() && !deposited.all) return;
  std::vector<bool> shown(2 * s.scene.primitives.size(), false);
  for (const caustics::SurfaceCaustics& c : s.caustics.surfaces)
    shown[particles::sideIndex(c.primitive, c.front)] = true;
  particles::Details details;
  particles::subdivideForParticles(s.elements, s.scene, s.particles, shown, details,
                                   particles::sidesThatKeepTheirMesh(s.scene, s.particles, deposited));
}

engine::Growth Engine::State::grow(const engine::SceneUpdate& edits, const particles::ParticleUpdate& followed,
                                   StepReport& step) {
  const engine::Clock time;
  engine::Growth growth = engine::growInLight(*solution, edits, followed);
  DELTALUX_VALIDATED(validate(solution->elements));
  step.times.hierarchy = time.seconds();
  return growth;
}

void Engine::State::evaluateAgain(paper::LinkMarks marks, const engine::Growth& growth, StepReport& step) {
  Solution& s = *solution;
  const paper::Parts parts{s.scene, *s.tracer, s.elements, s.links};
  const engine::Clock time;
  paper::arrive(parts, marks, {growth.root, growth.reactivated, growth.inactive});
  step.linksVisited = marks.visited;
  step.times.visibility += time.seconds();
  const engine::Clock refining;
  const paper::RefineReport refined = paper::follow(parts, marks, linkSettings(), *lists);
  s.report.counts.raysVisibility += refined.rays;
  step.linksChanged = refined.changed;
  step.times.refine = refining.seconds();
}

void Engine::State::placeParticles(const particles::ParticleUpdate& followed,
                                   std::span<const hierarchy::ElementId> changed) {
  const Solution& s = *solution;
  if (followed.all) transfer.reset();
  if (!transfer) {
    transfer.emplace(s.particles, s.elements, s.scene);
    return;
  }
  transfer->follow(s.particles, followed, s.elements, s.scene);
  transfer->followPatches(s.elements, changed);
}

bool Engine::State::refineByNewLight(Progress* progress) {
  Solution& s = *solution;
  const std::size_t elements = s.elements.size();
  const paper::RefineReport refined = refineLinks(linkSettings(), progress);
  if (s.elements.size() != elements) transfer->follow(s.particles, {}, s.elements, s.scene);
  return refined.created > 0 || refined.rays > 0;
}

}  // namespace deltalux
