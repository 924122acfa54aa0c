#pragma once
// Keeps the paper's textures up to edits [GD01 4]: those of surfaces whose particles are others now are made again;
// others hold the same deposits, and are multiplied by what their flux has become.
// Cost: some ten nanoseconds an impact, and the textures that are made.
#include "caustics/caustics.hpp"
#include "particles/particle_tracing.hpp"

namespace deltalux::paper {

/// Takes in paths that were traced again. Not for updates of all particles: then make new textures. Returns how many
/// textures it made.
std::size_t followTextures(caustics::Caustics&, const Scene&, const hierarchy::Elements&, const particles::Particles&,
                           const particles::ParticleUpdate&, double error);

}  // namespace deltalux::paper
