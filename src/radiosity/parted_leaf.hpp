#pragma once
// Leaves that are parted by what stands on them: a wall on the ground, a ceiling that goes on as eaves. Light on one
// side of the wall is none on the other, but a leaf has one radiosity: what falls on its part outside shines inside.
#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::radiosity {

/// Whether something stands between two quadrants of a flat leaf (0 to 3: u below or above the middle, then v), on a
/// quarter or more of some lines a little above it. Cost: 16 short rays.
bool standsBetween(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&, hierarchy::ElementId leaf,
                   std::size_t a, std::size_t b);

}  // namespace deltalux::radiosity
