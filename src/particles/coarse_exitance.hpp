#pragma once
// A first estimate of the irradiance of every diffuse sender cell. It decides how many particles a cell's links get and
// nothing else: what particles carry is the radiosity that is solved for. So it must not know what an edit of colours
// changes: lights count at scale 1, surfaces reflect a half. It is a function of the cell's few rays alone (keyed by
// the cell's name), so that an edit of geometry changes it only where one of these rays is crossed.
// Cost: kPaths paths of up to three vertices a cell, two shadow rays each.
#include "particles/senders.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

inline constexpr double kNominalReflectance = 0.5;  // of every diffuse surface

struct CoarseExitance {
  std::vector<float> perCell;  // gray: exitance of sender cells that are surfaces [W/m2], radiance of the sky's, else 1
  std::uint64_t rays = 0;
};

/// Radiance of the sky's cells, 1 of all others.
std::vector<float> skyStrengths(const Scene&, const Senders&);

CoarseExitance coarseExitance(const Scene&, const RayTracer&, const LightSampler&, const Senders&);

/// Adds what particles bring: `flux` by cell [W]. Light that only glass lets out, and caustics, are found by no shadow
/// ray.
void addFlux(CoarseExitance&, const Senders&, std::span<const double> flux);

}  // namespace deltalux
