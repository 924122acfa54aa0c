#pragma once
// Splits leaf patches where particles show detail that they are too large for, so that a caustic's light is sent on
// from where it lies: by the same estimated error that places particles in the hierarchy (transfer.hpp), four quarters
// against the whole. Links are untouched; they stay with the patch above.
// Cost: about 0.2 microseconds an impact and level.
#include "particles/particle_tracing.hpp"

namespace deltalux::particles {

/// Whether a patch shows what was deposited on it clearly worse than its quarters would.
enum class Detail : std::uint8_t { Unasked, Shown, Hidden };
/// By element. A function of what was deposited there, whatever it has been split into.
using Details = std::vector<Detail>;

/// Of sides that particles were on, or are, that were traced again: they are to be asked again.
void forget(Details&, const hierarchy::Elements&, const Particles&, const ParticleUpdate&);

/// Returns how many patches were split. `coarse`: sides that stay coarse, because textures show their particles; by
/// 2 * primitive + (front ? 0 : 1). They are split as far as others need to be lit by them, to a thirty-second part.
/// `keep`: sides that are not looked at, if any. `details`: what is known, and becomes so.
std::size_t subdivideForParticles(hierarchy::Elements&, const Scene&, const Particles&, const std::vector<bool>& coarse,
                                  Details& details, const std::vector<bool>& keep = {});

/// Sides for whose particles the mesh need not be looked at anew after these paths were traced: all but those of whose
/// flux, by nominal senders, new deposits bring a tenth or more.
std::vector<bool> sidesThatKeepTheirMesh(const Scene&, const Particles&, const ParticleUpdate&);

}  // namespace deltalux::particles
