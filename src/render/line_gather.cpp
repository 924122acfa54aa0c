#include "render/line_gather.hpp"

#include <algorithm>

#include "lines/tuning.hpp"

namespace deltalux::rendering {

namespace {
constexpr std::uint32_t kBatch = 64;  // lines of one independent estimate
constexpr int kFewestBatches = 16;    // before any judgement
}  // namespace

LineGather::LineGather(const Solution& s)
    : s_(s),
      leaves_(s.elements),
      locator_(s.elements, s.scene, leaves_),
      responses_(s.scene, !s.settings.diffuseOnly),
      tracer_(s.scene, *s.tracer, responses_) {}

ProbeResult LineGather::at(const Vec3f& p, const Vec3f& normal, double ambient, double error, std::uint64_t most,
                           std::uint64_t key) const {
  ProbeResult result;
  RgbSum sum(0.0), squares(0.0);
  const lines::LineDirections directions(key);
  const std::uint64_t batches = std::max<std::uint64_t>(most / kBatch, kFewestBatches);
  for (std::uint64_t batch = 0; batch < batches; ++batch) {
    RgbSum own(0.0);
    for (std::uint32_t k = 0; k < kBatch; ++k) {
      const auto i = static_cast<std::uint32_t>(batch * kBatch + k);
      const lines::LineEnd end =
          tracer_.follow(p, normal, directions(i, normal), lines::LineDirections::random(key, i));
      if (end.fate != lines::LineFate::Ended) continue;
      const std::uint32_t leaf = locator_.at(end.side, end.position);
      if (leaf == hierarchy::LeafTable::kNone) continue;
      const float ends = responses_.at(end.side.primitive, end.side.front).ends;
      if (ends > 0) own += RgbSum(end.weight * s_.elements.radiometry[leaves_[leaf].index()].B / ends);
    }
    own /= double(kBatch);
    sum += own, squares += own * own;
    result.samples += kBatch;
    const double n = double(batch + 1);
    result.irradiance = sum / n;
    result.standardError =
        glm::sqrt(glm::max(squares / n - result.irradiance * result.irradiance, RgbSum(0.0)) / std::max(n - 1, 1.0));
    if (batch + 1 >= kFewestBatches && gray(result.standardError) <= error * (gray(result.irradiance) + ambient)) break;
  }
  return result;
}

}  // namespace deltalux::rendering
