#pragma once
#include <functional>

#include "hierarchy/build.hpp"
#include "particles/particles.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::particles {

/// Whether light reaches a side in another way than by particles.
using IsLit = std::function<bool(PrimitiveId, std::uint32_t triangle, bool front)>;

/// Adds the sides that only particles reach (behind a lens, inside a glass case) to those that other light does, so
/// that they have elements; keeps the order of surfaceSides(). Particles of surfaces start anywhere on them, also under
/// what stands there: a path from where all that is seen is dark brings no light.
void addReachedSides(std::vector<hierarchy::SurfaceSide>&, const Particles&, const Scene&, const tracing::RayTracer&);
/// The same of some paths alone.
void addReachedSides(std::vector<hierarchy::SurfaceSide>&, const Particles&, std::span<const std::uint32_t> paths,
                     const Scene&, const tracing::RayTracer&, const IsLit&);
/// Takes out the sides that any particle lands on; `sides` in the order of surfaceSides().
void dropReachedSides(std::vector<hierarchy::SurfaceSide>& sides, const Particles&);

}  // namespace deltalux::particles
