#pragma once
// Direct light of leaves that it hardly reaches: through slots, keyholes, gaps beside doors. A few shadow rays tell
// nothing there, and none may pass though light does; so many points ask, each of them every sun and one lamp.
#include "direct/lamps.hpp"
#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::direct {

struct DimDirect {
  Rgb E{0.0f};          // mean over the points [W/m2]
  float deviation = 0;  // standard error of it, gray [W/m2]
  std::uint64_t rays = 0;
};

/// From these points of the leaf's sequence.
DimDirect dimDirect(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&, const Lamps&,
                    hierarchy::ElementId leaf, std::span<const std::uint32_t> points);

}  // namespace deltalux::direct
