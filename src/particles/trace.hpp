#pragma once
#include "particles/particles.hpp"

namespace deltalux::particles {

/// Traces the paths of counted links, in blocks: all first segments of a block at once, then all next ones, so that
/// rays reach the tracer in batches. Cost: about as much as the rays alone.
void tracePaths(const Scene&, const tracing::RayTracer&, const ParticleEmission&, int maxDepth, Particles&);

/// Traces these paths (ascending) anew; what they were stays in the arrays as a gap.
void retracePaths(const Scene&, const tracing::RayTracer&, const ParticleEmission&, int maxDepth, Particles&,
                  std::span<const std::uint32_t> paths);

}  // namespace deltalux::particles
