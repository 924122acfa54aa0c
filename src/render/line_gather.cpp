#include "render/line_gather.hpp"

#include "base/batch_mean.hpp"
#include "base/tuning.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"

namespace deltalux::rendering {

LineGather::LineGather(const Solution& s)
    : s_(s),
      leaves_(s.elements),
      locator_(s.elements, s.scene, leaves_),
      responses_(s.scene, s.settings.method == SolveMethod::Lines && !s.settings.diffuseOnly),
      tracer_(s.scene, *s.tracer, responses_) {}

Rgb LineGather::follow(const Vec3f& p, const Vec3f& normal, lines::LineDirections& directions, std::uint64_t key,
                       std::uint32_t i, hierarchy::ElementId& leaf) const {
  leaf = {};
  const lines::LineEnd end = tracer_.follow(p, normal, directions(i, normal), lines::LineDirections::random(key, i));
  if (end.termination != lines::LineTermination::Ended || (end.turned && !responses_.speculars())) return Rgb(0.0f);
  const std::uint32_t number = locator_.at(end.side, end.position);
  const float ends = responses_.at(end.side.primitive, end.side.front).ends;
  if (number == hierarchy::LeafTable::kNone || !(ends > 0)) return Rgb(0.0f);
  leaf = leaves_[number];
  return end.weight * s_.elements.radiometry[leaf.index()].B / ends;
}

void LineGather::forEachLine(const Vec3f& p, const Vec3f& normal, std::uint32_t count, std::uint64_t key,
                             const std::function<void(hierarchy::ElementId, const Rgb&)>& visit) const {
  lines::LineDirections directions(key);
  hierarchy::ElementId leaf;
  for (std::uint32_t i = 0; i < count; ++i)
    if (const Rgb B = follow(p, normal, directions, key, i, leaf); leaf.valid())
      visit(leaf, B / static_cast<float>(count));
}

ProbeResult LineGather::at(const Vec3f& p, const Vec3f& normal, double ambient, double error, std::uint64_t most,
                           std::uint64_t key) const {
  ProbeResult result;
  BatchMean mean;
  lines::LineDirections directions(key);
  hierarchy::ElementId leaf;
  while (mean.count() < deltalux::tuning::kFewestEstimates || result.samples < most) {
    RgbSum own(0.0);
    for (std::uint32_t k = 0; k < direct::kEstimateRays; ++k)
      own += RgbSum(follow(p, normal, directions, key, static_cast<std::uint32_t>(result.samples) + k, leaf));
    mean.add(own / double(direct::kEstimateRays));
    result.samples += direct::kEstimateRays;
    if (mean.count() >= deltalux::tuning::kFewestEstimates &&
        gray(mean.standardError()) <= error * (gray(mean.mean()) + ambient))
      break;
  }
  result.irradiance = mean.mean(), result.standardError = mean.standardError();
  return result;
}

}  // namespace deltalux::rendering
