// Particles, the mesh that they land on and the textures that show them follow edits. [GD01 4]
#include <utility>

#include "base/check.hpp"
#include "base/sort_unique.hpp"
#include "engine/state.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/side_index.hpp"

namespace deltalux {

particles::ParticleUpdate Engine::State::followWithParticles(std::size_t count, StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  particles::ParticleUpdate followed =
      tracing->allWait() ? tracing->retraceAll(s.particles) : tracing->retrace(s.particles, count);
  DELTALUX_VALIDATED(validate(s.particles, s.scene));
  constexpr std::size_t kTelling = 2048;  // fewer paths cost what starting costs
  if (followed.paths.size() >= kTelling) backlog.path.learn(time.seconds(), static_cast<double>(followed.paths.size()));
  backlog.add(followed);
  if (!backlog.frames) countParticles();
  step.particlesRetraced = followed.all ? s.particles.arrived() : followed.particles;
  step.particlesTotal = s.particles.arrived();
  step.times.particles += time.seconds();
  return followed;
}

bool Engine::State::subdivideWhereParticlesLanded(StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  if (!tracing) return false;
  if (backlog.landed.paths.empty() && !backlog.landed.all) return false;
  std::vector<bool> shown(2 * s.scene.primitives.size(), false);
  for (const caustics::SurfaceCaustics& c : s.caustics.surfaces)
    shown[particles::sideIndex(c.primitive, c.front)] = true;
  const std::size_t split = particles::subdivideForParticles(
      s.elements, s.scene, s.particles, shown, particles::sidesThatKeepTheirMesh(s.scene, s.particles, backlog.landed));
  step.times.particles += time.seconds();
  return split > 0;
}

void Engine::State::placeParticles(const particles::ParticleUpdate& followed, engine::LightChanges& light,
                                   StepReport& step) {
  const Solution& s = *solution;
  const engine::Clock time;
  if (followed.all) transfer.reset();
  light.allParticles = !transfer;
  if (transfer)
    light.surfaces = transfer->follow(s.particles, followed, s.elements, s.scene);
  else
    transfer.emplace(s.particles, s.elements, s.scene);
  step.times.particles += time.seconds();
}

/// How far they are spread depends on what patches reflect and how much of them is exposed.
void Engine::State::spreadParticlesAnew(engine::LightChanges& light) {
  if (light.allParticles) return;
  const hierarchy::Elements& elements = solution->elements;
  transfer->followPatches(elements, light.rows);  // which are looked at in any case
  const std::vector<hierarchy::ElementId> painted = transfer->followPatches(elements, light.painted);
  light.surfaces.insert(light.surfaces.end(), painted.begin(), painted.end());
  sortUnique(light.surfaces);
}

bool Engine::State::gapsAreMany(double most) const {
  const particles::Particles& p = solution->particles;
  std::size_t used = 0;
  for (const particles::PathRange& r : p.range) used += r.vertices;
  return static_cast<double>(p.vertices.size()) > most * static_cast<double>(used);
}

void Engine::State::closeGaps() {
  solution->particles.compact();
  transfer.reset(), upkeep.reset();
}

void Engine::State::followWithTextures(StepReport& step) {
  Solution& s = *solution;
  const engine::Clock time;
  const particles::ParticleUpdate followed = std::exchange(backlog.landed, {});
  if (!tracing && s.caustics.surfaces.empty()) return;
  if (!backlog.textures.empty()) s.caustics.surfaces = std::exchange(backlog.textures, {});
  if (!upkeep || followed.all) {
    upkeep.reset();
    makeTextures();
    step.texturesRebuilt = s.caustics.count();
  } else {
    step.texturesRebuilt = upkeep->follow(followed, *transfer, s.caustics).rebuilt;
    DELTALUX_VALIDATED(validate(s.caustics));
    countTextures();
  }
  step.times.textures = time.seconds();
}

}  // namespace deltalux
