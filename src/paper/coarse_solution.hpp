#pragma once
// A first answer before any link exists: a few short light paths from every side of every input-level surface
// (side_estimator.hpp). It tells refinement how large irradiances will be (so that no threshold is absolute), how far
// surroundings are, and which sides no light can reach: the inside of a closed box gets no element.
#include "hierarchy/build.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

struct CoarseReport {
  std::uint64_t rays = 0;
  std::size_t sides = 0, reachable = 0;
};

/// The sides that light can reach, with mean free path and a first estimate of irradiance.
std::vector<hierarchy::SurfaceSide> coarseSolution(const Scene&, const tracing::RayTracer&, CoarseReport* = nullptr);

}  // namespace deltalux::paper
