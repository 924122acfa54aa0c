#pragma once
// A first answer before any link exists: a few short light paths from every side of every input-level surface. It tells
// refinement how large irradiances will be (so that no threshold is absolute), how far surroundings are, and which
// sides no light can reach: the inside of a closed box gets no element. Cost: about 2^17 paths of up to four vertices,
// and in large scenes 24 of every side (8 of a mesh's triangle): fewer, and sides that little light reaches are lost.
#include "hierarchy/build.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct CoarseReport {
  std::uint64_t rays = 0;
  std::size_t sides = 0, reachable = 0;
};

/// The sides that light can reach, with mean free path and a first estimate of irradiance.
std::vector<SurfaceSide> coarseSolution(const Scene&, const RayTracer&, CoarseReport* = nullptr);

}  // namespace deltalux
