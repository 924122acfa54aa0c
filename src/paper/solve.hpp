#pragma once
// Hierarchical radiosity with clustering, of which links carry the light [GD01 2.1]: they are refined in rounds, each
// to a smaller error than the one before, and light converges over them after each, so that the next evaluates them by
// the light there is. The last round refines to what the error of irradiance that is asked for comes to for links.
//
// How errors map: docs/links.md. Cost: refinement, one kernel, one shaft and at most 16 rays a link; iteration, some
// ten nanoseconds a link and iteration. Nothing here depends on the number of threads.
#include <functional>

#include "base/tuning.hpp"
#include "hierarchy/link.hpp"
#include "paper/oracle.hpp"
#include "paper/refine.hpp"
#include "particles/transfer.hpp"

namespace deltalux::paper {

/// What a solve works on.
struct Parts {
  const Scene& scene;
  const tracing::RayTracer& tracer;
  hierarchy::Elements& elements;
  hierarchy::Links& links;
};

/// How links are evaluated in the last round, for a relative error of irradiance.
OracleSettings oracleSettingsFor(double error);
/// The error of links in the round after one of `error`, of a solve that ends at `least`.
/// Of the first round, before as many as light takes bounces to give a first idea of it.
double firstError(double error);
double nextError(double error, double least);

struct IterationReport {
  RgbSum emitted{0.0};   // what arrives of lights [W, with the scene's unit squared as area]
  RgbSum residual{0.0};  // that the last iteration changed, in the same unit
  std::uint64_t iterations = 0;
  bool whole = false;  // the residual is as small as was asked for
};

constexpr int kMaxIterations = 1024;  // halls of white plaster converge in some fifty [limit]
constexpr double kConverged =
    deltalux::tuning::kNegligible;  // residual power between rounds, over what arrives of lights
constexpr double kConvergedWell = deltalux::tuning::kConverged;  // the same in the end: dark corners too shall be right

/// What arrives of lights [W, with the scene's unit squared as area].
RgbSum directPower(const hierarchy::Elements&);

/// Gathers over all links, and from particles, until light no longer changes, from the light there is. `goOn` is asked
/// after every iteration.
IterationReport iterate(const Parts&, const particles::ParticleTransfer&, double converged,
                        const std::function<bool(const IterationReport&)>& goOn);

}  // namespace deltalux::paper
