#include "radiosity/covered_sides.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sort_unique.hpp"
#include "radiosity/side_estimator.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kLooks = 32;    // rays of a side, before paths
constexpr std::size_t kLines = 1024;  // through a box that was left
constexpr std::size_t kBoxes = 8;     // more are taken for one
constexpr double kMargin = 0.01;      // of a box's diagonal: how far beside it counts as in it
constexpr double kNear = 0.1;         // and as close by
constexpr std::uint64_t kLineKey = 0x756e636f7665726cull;

/// By side of the estimator. Looked: at its paths.
enum class State : char { Dark, Lit, Looked };

Box widened(const Box& box, double share = kMargin) {
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
  if (result.size() <= kBoxes) return result;
  Box all;
  for (const Box& box : result) all.extend(box);
  return {all};
}

class Search {
 public:
  Search(const Scene& scene, const RayTracer& tracer, const Elements& elements, std::span<const PrimitiveId> moved)
      : scene_(scene),
        tracer_(tracer),
        elements_(elements),
        estimator_(scene, tracer),
        state_(estimator_.sides().size(), State::Dark),
        moves_(scene.primitives.size(), 0),
        openSky_(std::any_of(scene.lights.begin(), scene.lights.end(),
                             [](const Light& light) { return std::holds_alternative<DomeLight>(light.emitter); })) {
    for (const PrimitiveId id : moved) moves_[id.index()] = 1;
    for (const ElementId e : elements.inputs)
      if (isSide(e) && !isAsleep(e)) state_[indexOf(e)] = State::Lit;
  }

  /// Of what moved: all dark sides but those that only see the like.
  void lookAtMoved() {
    std::vector<std::size_t> dark;
    for (std::size_t i = 0; i < state_.size(); ++i)
      if (state_[i] == State::Dark && moves_[primitiveOf(i)]) dark.push_back(i);
    std::vector<char> open(dark.size(), 0);
    parallelFor(dark.size(), 8, [&](std::size_t i) {
      const auto met = estimator_.firstMet(dark[i], kLooks);
      open[i] = std::any_of(met.begin(), met.end(), [&](const Hit& hit) {
        return !hit || !moves_[hit.primitive.index()] || state_[estimator_.indexOf(hit)] != State::Dark;
      });
    });
    for (std::size_t i = 0; i < dark.size(); ++i)
      if (open[i]) candidates_.push_back(dark[i]);
  }

  /// At what stands at the ends of lines through these boxes.
  void lookAlongLines(std::span<const Box> boxes) {
    std::vector<Ray> rays;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      Rng rng(combineKeys(kLineKey, b));
      const Box box = widened(boxes[b]);
      for (std::size_t k = 0; k < kLines; ++k) {
        Ray ray;
        const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
        ray.origin = Vec3f(box.lower + Vec3(x, y, z) * box.extent());
        const double c = 2 * rng.uniform() - 1, s = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * rng.uniform();
        ray.direction = Vec3f(Vec3(s * std::cos(phi), s * std::sin(phi), c));
        rays.push_back(ray);
        ray.direction = -ray.direction;
        rays.push_back(ray);
      }
    }
    std::vector<Hit> hits(rays.size());
    parallelBlocks(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
      tracer_.closestHits(std::span(rays).subspan(begin, end - begin), std::span(hits).subspan(begin, end - begin));
    });
    for (const Hit& hit : hits)
      if (hit) add(estimator_.indexOf(hit));
  }

  /// Estimates what was found, and what those of it that light reaches have met, until there is no more.
  std::vector<SurfaceSide> uncovered() {
    std::vector<std::size_t> found;
    while (!candidates_.empty()) {
      sortUnique(candidates_);
      for (const std::size_t i : candidates_) state_[i] = State::Looked;
      estimate(candidates_);
      found.insert(found.end(), candidates_.begin(), candidates_.end());
      candidates_.clear();
      for (std::size_t i = 0; i < state_.size(); ++i)
        if (estimator_.met(i)) add(i);
    }
    std::sort(found.begin(), found.end());
    std::vector<SurfaceSide> sides;
    for (const std::size_t i : found)
      if (estimator_.reached(i)) sides.push_back(estimator_.estimated(i));
    return sides;
  }

  /// Lit sides of what moved, and within its bounds, that light no longer reaches.
  std::vector<SurfaceSide> covered() {
    std::vector<Box> own;
    for (std::size_t i = 0; i < moves_.size(); ++i)
      if (moves_[i]) own.push_back(bounds(scene_.primitives[i].shape));
    std::vector<Box> within;
    for (const Box& box : joined(own)) within.push_back(widened(box));
    std::vector<std::size_t> closed;
    for (const ElementId e : elements_.inputs) {
      if (!isSide(e) || isAsleep(e) || elements_.at(e).blocker) continue;
      for (const Box& box : within)
        if (holds(box, elements_.box(e)) && noRayLeaves(widened(box, kNear), indexOf(e))) {
          closed.push_back(indexOf(e));
          break;
        }
    }
    std::sort(closed.begin(), closed.end());  // elements that have grown stand behind all others
    estimate(closed);
    std::vector<SurfaceSide> sides;
    for (const std::size_t i : closed)
      if (!estimator_.reached(i)) sides.push_back(estimator_.estimated(i));
    return sides;
  }

 private:
  std::size_t primitiveOf(std::size_t side) const { return estimator_.sides()[side].primitive.index(); }
  bool isSide(ElementId e) const {
    return elements_.isInputLevel(e) && !elements_.at(e).emitter && elements_.shape(e).area > 0;
  }
  bool isAsleep(ElementId e) const { return std::binary_search(elements_.asleep.begin(), elements_.asleep.end(), e); }
  std::size_t indexOf(ElementId e) const {
    const PatchDomain& d = elements_.domain[e.index()];
    return estimator_.indexOf(d.primitive, d.triangle, elements_.at(e).front);
  }
  static bool holds(const Box& box, const Box& inner) { return box.contains(inner.lower) && box.contains(inner.upper); }
  /// Those that meet nothing are of sides that lie upon others, or of a scene that is open: no light comes from there
  /// without a sky.
  bool noRayLeaves(const Box& box, std::size_t side) const {
    const auto met = estimator_.firstMet(side, kLooks);
    return std::all_of(met.begin(), met.end(),
                       [&](const Hit& hit) { return hit ? box.contains(Vec3(hit.position)) : !openSky_; });
  }
  void add(std::size_t side) {
    if (state_[side] == State::Dark) candidates_.push_back(side);
  }
  void estimate(const std::vector<std::size_t>& sides) {
    parallelFor(sides.size(), 4, [&](std::size_t i) { estimator_.estimate(sides[i]); });
  }

  const Scene& scene_;
  const RayTracer& tracer_;
  const Elements& elements_;
  SideEstimator estimator_;
  std::vector<State> state_;
  std::vector<char> moves_;  // by primitive
  bool openSky_;
  std::vector<std::size_t> candidates_;
};

}  // namespace

CoveredSides coveredSides(const Scene& scene, const RayTracer& tracer, const Elements& elements,
                          std::span<const PrimitiveId> moved, std::span<const Box> left) {
  Search search(scene, tracer, elements, moved);
  search.lookAtMoved();
  search.lookAlongLines(joined(left));
  CoveredSides sides;
  sides.uncovered = search.uncovered();
  sides.covered = search.covered();
  return sides;
}

}  // namespace deltalux
