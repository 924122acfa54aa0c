#pragma once
#include "particles/particles.hpp"

namespace deltalux::particles {

/// Everything about particles but their paths: who sends, and the links. It is the same for every count.
struct ParticlePlan {
  Particles empty;  // senders, and the rays that decided
  DsLinks links;
};

/// A scene with edits is evaluated at rest, with an Embree tracer of its own.
ParticlePlan planParticles(const Scene&, const tracing::RayTracer&, const ParticleSettings&);

/// Particles that are to be traced: how many paths each link gets.
Particles counted(const ParticlePlan&, std::uint64_t count);

}  // namespace deltalux::particles
