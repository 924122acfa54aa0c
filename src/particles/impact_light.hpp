#pragma once
// Of a single impact or path: where it is in the scene, and what its sender gives it today.
#include "hierarchy/side_locator.hpp"
#include "particles/particles.hpp"

namespace deltalux::particles {

Vec3 positionOf(const Impact&, const Scene&);

/// What a path's throughput is multiplied by for its flux. `scales`: of lights.
Rgb powerOf(const Particles&, std::size_t path, const hierarchy::Elements&, const hierarchy::SideLocator&,
            std::span<const Rgb> scales);

}  // namespace deltalux::particles
