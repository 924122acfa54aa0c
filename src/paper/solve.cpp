#include "paper/solve.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "paper/gather.hpp"
#include "paper/push_pull.hpp"
#include "paper/tuning.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::paper {

RgbSum directPower(const hierarchy::Elements& e) {
  return parallelSum<RgbSum>(e.inputs.size(), 4096, [&](std::size_t i) {
    const hierarchy::ElementId input = e.inputs[i];
    return e.receives(input) ? double(e.shape(input).litArea()) * RgbSum(e.radiometry[input.index()].direct)
                             : RgbSum(0.0);
  });
}

OracleSettings oracleSettingsFor(double error) {
  OracleSettings settings;
  settings.error = tuning::kLinkError * error;
  return settings;
}

double firstError(double error) { return std::ldexp(error, deltalux::tuning::kPilotBounces); }

double nextError(double error, double least) { return std::max(least, error / 2); }

IterationReport iterate(const Parts& parts, const particles::ParticleTransfer& onMesh, double converged,
                        const std::function<bool(const IterationReport&)>& goOn) {
  const GatherPlan plan(parts.links, parts.elements);
  plan.gatherDirect(parts.elements);
  IterationReport s;
  while (s.iterations < kMaxIterations) {
    plan.gatherIndirect(parts.elements);
    onMesh.apply(parts.elements, scene::scalesOf(parts.scene));
    s.residual = pushPull(parts.elements);
    ++s.iterations;
    s.emitted = directPower(parts.elements);
    s.whole = gray(s.residual) <= converged * gray(s.emitted);
    if (s.whole || !goOn(s)) break;
  }
  return s;
}

}  // namespace deltalux::paper
