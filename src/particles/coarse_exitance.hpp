#pragma once
// A first estimate of the exitance of every diffuse sender cell. It decides how many particles a cell's links get and
// nothing else: what particles carry is the radiosity that is solved for. So it must not know what an edit of colours
// changes: lights count at scale 1, surfaces reflect a half.
//
// A cell's irradiance is that of lights, by a few shadow rays, and that of caustics, by particles from lights that are
// traced beforehand; from there it goes over a few rays from cell to cell, as often as light bounces.
// Cost: kPoints shadow rays a cell and as many rays to other cells, and at each point one sample of every light.
#include "particles/senders.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::particles {

struct CoarseExitance {
  std::vector<float> perCell;  // gray: exitance of sender cells that are surfaces [W/m2], radiance of the sky's, else 1
  std::uint64_t rays = 0;
};

/// Radiance of the sky's cells, 1 of all others.
std::vector<float> skyStrengths(const Scene&, const Senders&);

/// `lights` at scale 1; `caustics`: flux that particles from lights bring, by sender cell [W].
CoarseExitance coarseExitance(const Scene&, const tracing::RayTracer&, const scene::LightSampler& lights,
                              const Senders&, std::span<const double> caustics);

}  // namespace deltalux::particles
