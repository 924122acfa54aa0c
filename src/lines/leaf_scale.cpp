#include "lines/leaf_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/square.hpp"
#include "base/tuning.hpp"
#include "base/usual_error.hpp"
#include "hierarchy/tuning.hpp"
#include "lines/scene_widths.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

ScaleMeter::ScaleMeter(const hierarchy::Elements& elements, const LineTracer& tracer, const Cover& cover,
                       const std::vector<char>& enclosed)
    : elements_(elements),
      tracer_(tracer),
      cover_(cover),
      enclosed_(enclosed),
      farthest_(static_cast<float>(widthsOf(tracer.scene(), elements.sceneBox).farthest)) {}

LeafScale ScaleMeter::measure(hierarchy::ElementId patch, FirstLines& first) const {
  const hierarchy::LeafSequence points(elements_, tracer_.scene(), patch);
  LineDirections directions(points.key());
  const PrimitiveId own = elements_.domain[patch.index()].primitive;
  const Cover::About about = cover_.about(elements_, patch);
  constexpr std::uint32_t kBatch = hierarchy::LeafSequence::kBatch;
  static_assert(deltalux::tuning::kPilots == kBatch, "one batch tells");
  std::array<tracing::Ray, kBatch> rays;
  std::array<tracing::Hit, kBatch> hits;
  std::array<std::uint32_t, kBatch> which;
  LeafScale scale;
  double inverse = 0, sum = 0;
  std::uint32_t open = 0;
  bool hollow = false;  // whether some lines end in enclosed hollows, so that lines alone tell what is covered
  // Where something lies on the patch, how much of it is worth knowing.
  for (; scale.known < (scale.covered ? 64u : kBatch); scale.known += kBatch) {
    std::size_t live = 0;
    for (std::uint32_t i = scale.known; i < scale.known + kBatch; ++i) {
      const hierarchy::PatchPoint x = points.point(i);
      if (cover_.covers(x.position, x.normal, own, about, scale.rays)) {
        scale.covered |= std::uint64_t(1) << i;
        if (i < kBatch) first.line[i] = coveredLine(directions(i, x.normal));
        continue;
      }
      if (i >= kBatch && !hollow) continue;
      const Vec3f w = directions(i, x.normal);
      rays[live].origin = tracing::offsetOrigin(x.position, x.normal, w), rays[live].direction = w;
      which[live++] = i;
    }
    tracer_.tracer().closestHits(std::span(rays).first(live), std::span(hits).first(live));
    scale.rays += static_cast<std::uint32_t>(live);
    for (std::size_t k = 0; k < live; ++k) {
      const LineEnd end = tracer_.follow(rays[k], hits[k], LineDirections::random(points.key(), which[k]));
      const hierarchy::ElementId side = end.termination == LineTermination::Ended && !end.turned
                                            ? elements_.sides.at(end.side)
                                            : hierarchy::ElementId();
      const bool covered = side.valid() && enclosed_[hierarchy::surfaceOf(elements_, side).index()];
      if (which[k] < kBatch)
        first.line[which[k]] = firstLine(end, rays[k].direction, covered);
      else
        first.beyond.push_back(lineCode(rays[k].direction, end.distance));
      if (covered) {
        scale.covered |= std::uint64_t(1) << which[k], hollow = true;
        continue;
      }
      const float t = std::min(end.distance, farthest_);
      inverse += std::isinf(end.distance) ? 0.0 : 1.0 / std::max(t, 1e-20f), sum += t, ++open;
    }
  }
  if (open > 0) {
    scale.mean = static_cast<float>(sum / open);
    if (inverse > 0) scale.harmonic = static_cast<float>(open / inverse);
  }
  return scale;
}

void setMeanFreePaths(hierarchy::Elements& elements, const std::vector<LeafScale>& scales) {
  // Of sides below each cluster: the mean of logarithms, in which one vast meadow counts as one.
  std::vector<double> sum(elements.size(), 0), count(elements.size(), 0);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const hierarchy::ElementTopology& t = elements.topology[i];
    const bool side = t.kind == hierarchy::ElementKind::Patch && t.depth == 0 && !t.emitter && !t.blocker;
    if (side && scales[i].mean > 0) sum[i] = std::log(double(scales[i].mean)), count[i] = 1;
    if (t.parent.valid()) sum[t.parent.index()] += sum[i], count[t.parent.index()] += count[i];
  }
  for (const hierarchy::ElementId input : elements.inputs) {
    if (!elements.receives(input)) continue;
    hierarchy::ElementId about = elements.at(input).parent;
    for (int up = 1; up < tuning::kClustersUp && elements.at(about).parent.valid(); ++up)
      about = elements.at(about).parent;
    const double n = count[about.index()], usual = n > 0 ? std::exp(sum[about.index()] / n) : 0.0;
    elements.geometry[input.index()].meanFreePath =
        std::max(scales[input.index()].mean, static_cast<float>(hierarchy::tuning::kNarrowPlace * usual));
  }
}

bool tooWide(const hierarchy::ElementGeometry& g, const LeafScale& scale, double error, double dim, double room) {
  if (!(scale.mean > 0)) return false;
  const bool wide = scale.mean > room && dim > square(tuning::kDimWidth);
  if (scale.mean <= hierarchy::tuning::kNarrowPlace * g.radius && !wide) return false;
  const double wider = std::clamp(1 / std::sqrt(std::max(dim, 1e-12)), 1.0, tuning::kDimWidth);
  const double finer = wider * std::sqrt(error / kUsualError);
  return g.radius > tuning::kWidth * finer * scale.harmonic &&
         g.radius > tuning::kFinestWidth * finer * std::max(scale.mean, g.meanFreePath);
}

}  // namespace deltalux::lines
