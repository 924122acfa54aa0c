#include "lines/leaf_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/leaf_sequence.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

ScaleMeter::ScaleMeter(const hierarchy::Elements& elements, const LineTracer& tracer, const Cover& cover,
                       const std::vector<char>& enclosed)
    : elements_(elements),
      tracer_(tracer),
      cover_(cover),
      enclosed_(enclosed),
      farthest_(static_cast<float>(elements.sceneBox.diagonal())) {}

LeafScale ScaleMeter::measure(hierarchy::ElementId patch) const {
  const hierarchy::LeafSequence points(elements_, tracer_.scene(), patch);
  const LineDirections directions(points.key());
  const PrimitiveId own = elements_.domain[patch.index()].primitive;
  const bool touched = cover_.mayTouch(elements_, patch);
  constexpr std::uint32_t kBatch = hierarchy::LeafSequence::kBatch;
  static_assert(tuning::kFirstLines == kBatch, "one batch tells");
  std::array<tracing::Ray, kBatch> rays;
  std::array<tracing::Hit, kBatch> hits;
  std::array<std::uint32_t, kBatch> which;
  LeafScale scale;
  double inverse = 0, sum = 0;
  std::uint32_t open = 0;
  // Where something lies on the patch, how much of it is worth knowing.
  for (; scale.known < (scale.covered ? 64u : kBatch); scale.known += kBatch) {
    std::size_t live = 0;
    for (std::uint32_t i = scale.known; i < scale.known + kBatch; ++i) {
      const hierarchy::PatchPoint x = points.point(i);
      if (touched && ++scale.rays && cover_.covers(x.position, x.normal, own)) {
        scale.covered |= std::uint64_t(1) << i;
        continue;
      }
      const Vec3f w = directions(i, x.normal);
      rays[live].origin = tracing::offsetOrigin(x.position, x.normal, w), rays[live].direction = w;
      which[live++] = i;
    }
    tracer_.tracer().closestHits(std::span(rays).first(live), std::span(hits).first(live));
    scale.rays += static_cast<std::uint32_t>(live);
    for (std::size_t k = 0; k < live; ++k) {
      const LineEnd end = tracer_.follow(rays[k], hits[k], LineDirections::random(points.key(), which[k]));
      const hierarchy::ElementId side =
          end.fate == LineFate::Ended && !end.turned ? elements_.sides.at(end.side) : hierarchy::ElementId();
      if (side.valid() && enclosed_[side.index()]) {
        scale.covered |= std::uint64_t(1) << which[k];
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
  std::vector<double> area(elements.size(), 0), path(elements.size(), 0);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const hierarchy::ElementTopology& t = elements.topology[i];
    hierarchy::ElementGeometry& g = elements.geometry[i];
    if (t.emitter) continue;
    if (t.kind == hierarchy::ElementKind::Patch) {
      if (t.depth > 0 || t.blocker) continue;
      g.meanFreePath = std::max(scales[i].mean, std::sqrt(g.area));
      area[i] = g.area, path[i] = double(g.area) * scales[i].mean;
    } else if (area[i] > 0) {
      g.meanFreePath = static_cast<float>(path[i] / area[i]);
    }
    if (t.parent.valid()) area[t.parent.index()] += area[i], path[t.parent.index()] += path[i];
  }
  for (const hierarchy::ElementId input : elements.inputs) {
    if (!elements.receives(input)) continue;
    const hierarchy::ElementId parent = elements.at(input).parent, second = elements.at(parent).parent;
    float& own = elements.geometry[input.index()].meanFreePath;
    own = std::max(own, tuning::kSurroundings * elements.shape(second.valid() ? second : parent).meanFreePath);
  }
}

bool tooWide(const hierarchy::ElementGeometry& g, const LeafScale& scale, double error) {
  if (!(scale.mean > 0)) return false;
  const double finer = std::sqrt(error / tuning::kBaseError);
  return g.radius > tuning::kWidth * finer * scale.harmonic && scale.mean > tuning::kSlot * g.radius &&
         g.radius > tuning::kFinestWidth * finer * std::max(scale.mean, g.meanFreePath);
}

}  // namespace deltalux::lines
