#pragma once
// The tuned constants of solving, updating and frames: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::engine::tuning {

/// Particles at an error of one; they are as one over its square. Fewer: textures are blurred, and caustics on the mesh
/// are noise. More: time and memory in proportion.
constexpr double kParticlesAtUnitError = 1000;

/// Of a frame, of what is left of a limited time for lines, or of all of it for links, that is planned: the rest keeps
/// it in time where work takes longer than learned. More: late frames.
constexpr double kPlanned = 0.8;
/// Passes of light that a frame keeps time for. Fewer: late frames. More: leaves that follow late.
constexpr double kPassesOfFrame = 2;

}  // namespace deltalux::engine::tuning
