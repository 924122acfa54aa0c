#pragma once
#include "particles/particles.hpp"

namespace deltalux::particles {

/// Everything about particles but their paths: who sends, the links, and how many paths each gets. A scene with edits
/// is judged at rest, with an Embree tracer of its own.
Particles planParticles(const Scene&, const tracing::RayTracer&, const ParticleSettings&);

}  // namespace deltalux::particles
