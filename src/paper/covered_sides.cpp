#include "paper/covered_sides.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/few_boxes.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sort_unique.hpp"
#include "base/tuning.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/tuning.hpp"
#include "paper/side_estimator.hpp"
#include "particles/flux_estimate.hpp"

namespace deltalux::paper {

namespace {

constexpr std::uint64_t kLineKey = 0x756e636f7665726cull;  // [key]

Box widened(const Box& box, double share = hierarchy::tuning::kTouching) {
  const double margin = share * box.diagonal();
  return {box.lower - margin, box.upper + margin};
}

/// Boxes that overlap made one, and all of them one where there are many.
std::vector<Box> joined(std::span<const Box> boxes) {
  std::vector<Box> result;
  for (Box box : boxes) {
    if (box.empty()) continue;
    for (std::size_t i = 0; i < result.size();) {
      if (!result[i].overlaps(box)) {
        ++i;
        continue;
      }
      box.extend(result[i]);
      result.erase(result.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
    result.push_back(box);
  }
  if (result.size() <= kFewBoxes) return result;
  Box all;
  for (const Box& box : result) all.extend(box);
  return {all};
}

class Search {
 public:
  Search(const Scene& scene, const tracing::RayTracer& tracer, const hierarchy::Elements& elements,
         std::span<const PrimitiveId> moved)
      : scene_(scene),
        tracer_(tracer),
        elements_(elements),
        estimator_(scene, tracer, sideCount(scene)),
        moved_(moved.begin(), moved.end()),
        openSky_(std::any_of(scene.lights.begin(), scene.lights.end(),
                             [](const Light& light) { return std::holds_alternative<DomeLight>(light.emitter); })) {
    sortUnique(moved_);
  }

  /// Of what moved: all dark sides but those that only see the like.
  void lookAtMoved() {
    std::vector<hierarchy::Side> dark;
    for (const PrimitiveId primitive : moved_)
      hierarchy::forEachSide(scene_, primitive, [&](const hierarchy::Side& s) {
        if (!isLit(s)) dark.push_back(s);
      });
    std::vector<char> open(dark.size(), 0);
    parallelFor(dark.size(), 8, [&](std::size_t i) {
      const auto met = estimator_.firstMet(dark[i], deltalux::tuning::kPilots);
      open[i] = std::any_of(met.begin(), met.end(), [&](const tracing::Hit& hit) {
        return !hit || !moves(hit.primitive) || isLit(sideOf(hit));
      });
    });
    for (std::size_t i = 0; i < dark.size(); ++i)
      if (open[i]) candidates_.push_back(dark[i]);
  }

  /// At what stands at the ends of lines through these boxes.
  void lookAlongLines(std::span<const Box> boxes) {
    std::vector<tracing::Ray> rays;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      Rng rng(combineKeys(kLineKey, b));
      const Box box = widened(boxes[b]);
      for (std::size_t k = 0; k < static_cast<std::size_t>(particles::kMostLooks); ++k) {
        tracing::Ray ray;
        const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
        ray.origin = Vec3f(box.lower + Vec3(x, y, z) * box.extent());
        const double c = 2 * rng.uniform() - 1, s = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * rng.uniform();
        ray.direction = Vec3f(Vec3(s * std::cos(phi), s * std::sin(phi), c));
        rays.push_back(ray);
        ray.direction = -ray.direction;
        rays.push_back(ray);
      }
    }
    std::vector<tracing::Hit> hits(rays.size());
    parallelBlocks(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
      tracer_.closestHits(std::span(rays).subspan(begin, end - begin), std::span(hits).subspan(begin, end - begin));
    });
    for (const tracing::Hit& hit : hits)
      if (hit) add(sideOf(hit));
  }

  /// Estimates what was found, and what those of it that light reaches have met, until there is no more.
  std::vector<hierarchy::SurfaceSide> uncovered() {
    while (!candidates_.empty()) {
      sortUnique(candidates_);
      estimate(std::exchange(candidates_, {}));
    }
    return found([&](const hierarchy::Side& s) { return isReached(s); });
  }

  /// Lit sides of what moved, and within its bounds, that light no longer reaches.
  std::vector<hierarchy::SurfaceSide> covered() {
    std::vector<Box> ofMoved;
    for (const PrimitiveId primitive : moved_) ofMoved.push_back(bounds(scene_[primitive].shape));
    std::vector<Box> within;
    for (const Box& box : joined(ofMoved)) within.push_back(widened(box));
    std::vector<hierarchy::Side> closed;
    for (const hierarchy::ElementId root : elements_.sceneRoots())
      hierarchy::forEachBelow(elements_, root, [&](hierarchy::ElementId e) {
        const Box own = elements_.box(e);
        if (elements_.isCluster(e))
          return std::any_of(within.begin(), within.end(), [&](const Box& box) { return box.overlaps(own); });
        if (!isAwake(e) || elements_.at(e).blocker) return false;
        const hierarchy::Side s = elements_.sideOf(e);
        if (std::any_of(within.begin(), within.end(), [&](const Box& box) {
              return holds(box, own) && noRayLeaves(widened(box, hierarchy::tuning::kTouching), s);
            }))
          closed.push_back(s);
        return false;
      });
    std::sort(closed.begin(), closed.end());
    estimates_.clear();
    estimate(closed);
    return found([&](const hierarchy::Side& s) { return !isReached(s); });
  }

 private:
  static std::size_t sideCount(const Scene& scene) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene.primitives.size(); ++i)
      hierarchy::forEachSide(scene, PrimitiveId(i), [&](const hierarchy::Side&) { ++count; });
    return count;
  }
  hierarchy::Side sideOf(const tracing::Hit& hit) const { return deltalux::paper::sideOf(scene_, hit); }
  bool moves(PrimitiveId primitive) const { return std::binary_search(moved_.begin(), moved_.end(), primitive); }
  bool isAwake(hierarchy::ElementId e) const {
    return elements_.shape(e).area > 0 && !std::binary_search(elements_.inactive.begin(), elements_.inactive.end(), e);
  }
  /// It has elements that are active.
  bool isLit(const hierarchy::Side& s) const {
    const hierarchy::ElementId e = elements_.sides.at(s);
    return e.valid() && isAwake(e);
  }
  /// By what is estimated.
  bool isReached(const hierarchy::Side& side) const {
    return deltalux::paper::isReached(scene_, side, [&](const hierarchy::Side& s) { return reached_.contains(s); });
  }
  static bool holds(const Box& box, const Box& inner) { return box.contains(inner.lower) && box.contains(inner.upper); }
  /// Those that meet nothing are of sides that lie upon others, or of a scene that is open: no light comes from there
  /// without a sky.
  bool noRayLeaves(const Box& box, const hierarchy::Side& side) const {
    const auto met = estimator_.firstMet(side, deltalux::tuning::kPilots);
    return std::all_of(met.begin(), met.end(),
                       [&](const tracing::Hit& hit) { return hit ? box.contains(Vec3(hit.position)) : !openSky_; });
  }
  void add(const hierarchy::Side& side) {
    if (!estimates_.contains(side) && !isLit(side)) candidates_.push_back(side);
  }
  /// Sides, each of them once; finds further candidates.
  void estimate(const std::vector<hierarchy::Side>& sides) {
    std::vector<SideEstimate> estimates(sides.size());
    parallelFor(sides.size(), 4, [&](std::size_t i) { estimates[i] = estimator_.estimate(sides[i]); });
    for (const SideEstimate& e : estimates) {
      estimates_[e.side.side()] = e.side;
      if (!isBlack(e.side.irradiance)) reached_.insert(e.side.side());
      reached_.insert(e.lit.begin(), e.lit.end());
    }
    for (SideEstimate& e : estimates) {
      sortUnique(e.met);
      for (const hierarchy::Side& s : e.met) add(s);
    }
  }
  template <class Wanted>
  std::vector<hierarchy::SurfaceSide> found(const Wanted& wanted) const {
    std::vector<hierarchy::SurfaceSide> sides;
    for (const auto& [side, estimated] : estimates_)
      if (wanted(side)) sides.push_back(estimated);
    return sides;
  }

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const hierarchy::Elements& elements_;
  SideEstimator estimator_;
  std::vector<PrimitiveId> moved_;  // ascending
  bool openSky_;
  std::vector<hierarchy::Side> candidates_;
  std::map<hierarchy::Side, hierarchy::SurfaceSide> estimates_;
  std::set<hierarchy::Side> reached_;
};

}  // namespace

CoveredSides coveredSides(const Scene& scene, const tracing::RayTracer& tracer, const hierarchy::Elements& elements,
                          std::span<const PrimitiveId> moved, std::span<const Box> left) {
  Search search(scene, tracer, elements, moved);
  search.lookAtMoved();
  search.lookAlongLines(joined(left));
  CoveredSides sides;
  sides.uncovered = search.uncovered();
  sides.covered = search.covered();
  return sides;
}

}  // namespace deltalux::paper
