#pragma once
// Direct light of leaves that it hardly reaches: through slots, keyholes, gaps beside doors. A few shadow rays tell
// nothing there, and none may pass though light does; so many points ask, each of them every sun and one lamp.
#include <functional>

#include "direct/lamp_light.hpp"
#include "direct/lamps.hpp"
#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::direct {

struct DimDirect {
  std::vector<LampLight> lamps;  // means over the points
  std::uint64_t rays = 0;
};

/// From these points of the leaf's sequence.
DimDirect dimDirect(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&, const Lamps&,
                    hierarchy::ElementId leaf, std::span<const std::uint32_t> points);

/// Whether one of the shadow rays that it takes is stopped.
bool anyDimRay(const hierarchy::Elements&, const Scene&, const Lamps&, hierarchy::ElementId leaf,
               std::span<const std::uint32_t> points, const std::function<bool(const tracing::Ray&)>& stops);

}  // namespace deltalux::direct
