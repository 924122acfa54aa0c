#pragma once
#include "hierarchy/build.hpp"
#include "particles/particles.hpp"

namespace deltalux {

/// Adds the sides that only particles reach (behind a lens, inside a glass case) to those that other light does, so
/// that they have elements; keeps the order of surfaceSides().
void addReachedSides(std::vector<SurfaceSide>&, const Particles&, const Scene&);
/// The same of some paths alone.
void addReachedSides(std::vector<SurfaceSide>&, const Particles&, std::span<const std::uint32_t> paths, const Scene&);
/// Takes out the sides that any particle lands on; `sides` in the order of surfaceSides().
void dropReachedSides(std::vector<SurfaceSide>& sides, const Particles&);

}  // namespace deltalux
