#include "paper/hidden_elements.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/tuning.hpp"
#include "paper/separation.hpp"

namespace deltalux::paper {

namespace {

/// Solid angle of an occluder about the middle of what moved: less hides next to nothing.
constexpr double kLeastCovered = 4 * kPi * deltalux::tuning::kNegligible;  // [defined]
constexpr double kSlack = 1e-5;  // of the coordinates: what must lie between, for what rounding does [rounding]

bool isConvex(std::span<const Vec3> outline, const Vec3& normal) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()], &c = outline[(i + 2) % outline.size()];
    if (!(glm::dot(glm::cross(b - a, c - b), normal) > 0)) return false;
  }
  return true;
}

/// Inside: dot(n, p) > d.
struct Plane {
  Vec3f n;
  float d;
};

/// Convex regions, each within some planes, in which all of a box is hidden.
class Umbras {
 public:
  Umbras(const hierarchy::Elements& elements, const Scene& scene, const Box& region)
      : elements_(elements),
        scene_(scene),
        region_(region),
        middle_(region.center()),
        corners_(cornersOf(region.lower, region.upper)) {
    for (const hierarchy::ElementId root : elements.sceneRoots()) collect(root);
    std::sort(umbras_.begin(), umbras_.end(), [](const Umbra& a, const Umbra& b) {
      return a.covered != b.covered ? a.covered > b.covered : a.first < b.first;
    });
  }

  std::vector<HiddenElement> hidden() {
    for (std::uint32_t u = 0; u < umbras_.size(); ++u) candidates_.push_back(u);
    const std::size_t all = candidates_.size();
    for (const hierarchy::ElementId root : elements_.sceneRoots()) find(root, 0, all);
    return std::move(hidden_);
  }

 private:
  struct Umbra {
    std::uint32_t first, count;  // of planes
    hierarchy::ElementId occluder;
    float covered;  // solid angle, about
  };
  enum class Place : char { Outside, Across, Inside };

  void collect(hierarchy::ElementId e) {
    const hierarchy::ElementGeometry& g = elements_.shape(e);
    const Vec3 away = glm::max(glm::max(region_.lower - Vec3(g.upper), Vec3(g.lower) - region_.upper), Vec3(0.0));
    if (kPi * g.radius * g.radius < kLeastCovered * glm::dot(away, away)) return;
    if (elements_.isPatch(e)) return collectPatch(e);
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) collect(elements_.child(e, i));
  }

  void collectPatch(hierarchy::ElementId e) {
    const hierarchy::ElementTopology& t = elements_.at(e);
    const hierarchy::PatchDomain& d = elements_.domain[e.index()];
    if (!t.flat || t.blocker || !(elements_.shape(e).area > 0) || passesStraight(scene_.materialOf(d.primitive)))
      return;
    if (d.primitive == last_ && d.triangle == lastTriangle_) return;  // its other side
    last_ = d.primitive, lastTriangle_ = d.triangle;
    const hierarchy::PlaneFrame& f = elements_.frames[d.frame];
    std::vector<Vec3> outline;
    for (const Vec2& q : elements_.outline(e)) outline.push_back(f.at(q));
    if (outline.size() <= kMostCorners && isConvex(outline, f.normal)) return add(e, outline, f.normal);
    const auto* polygon = std::get_if<Polygon>(&scene_[d.primitive].shape);
    if (!polygon) return;
    for (const auto& triangle : polygon->triangles) {
      const std::array<Vec3, 3> part{polygon->vertices[triangle[0]], polygon->vertices[triangle[1]],
                                     polygon->vertices[triangle[2]]};
      add(e, part, f.normal);
    }
  }

  /// The umbra of a convex polygon.
  void add(hierarchy::ElementId occluder, std::span<const Vec3> outline, Vec3 normal) {
    Vec3 area(0.0), center(0.0);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      area += 0.5 * glm::cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
      center += outline[i] / static_cast<double>(outline.size());
    }
    const Vec3 d = center - middle_;
    const double squared = glm::dot(d, d);
    const double covered = std::abs(glm::dot(area, d)) / (squared * std::sqrt(squared));
    if (!(covered > kLeastCovered)) return;
    if (glm::dot(normal, d) < 0) normal = -normal;  // beyond is where it points
    const double slack = slackAt(center);
    std::array<double, 8> depth;
    for (std::size_t k = 0; k < 8; ++k) {
      depth[k] = glm::dot(center - corners_[k], normal);
      if (!(depth[k] > slack)) return;
    }
    const auto first = static_cast<std::uint32_t>(planes_.size());
    add(normal, center, slack);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 &a = outline[i], edge = outline[(i + 1) % outline.size()] - a;
      Vec3 inward = glm::normalize(glm::cross(normal, edge));
      if (glm::dot(inward, center - a) < 0) inward = -inward;
      // Of all lines through the edge and the box the one that goes farthest in beyond it.
      double slope = -kInfinity;
      for (std::size_t k = 0; k < 8; ++k) slope = std::max(slope, glm::dot(inward, a - corners_[k]) / depth[k]);
      add(glm::normalize(inward - slope * normal), a, slack);
    }
    umbras_.push_back(
        {first, static_cast<std::uint32_t>(planes_.size()) - first, occluder, static_cast<float>(covered)});
  }

  void add(const Vec3& n, const Vec3& through, double slack) {
    planes_.push_back({Vec3f(n), static_cast<float>(glm::dot(n, through) + slack)});
  }

  double slackAt(const Vec3& p) const {
    const Vec3 size = glm::max(glm::abs(p), glm::max(glm::abs(region_.lower), glm::abs(region_.upper)));
    return kSlack * std::max({size.x, size.y, size.z, 1e-3});
  }

  Place placeOf(const hierarchy::ElementGeometry& g, const Umbra& umbra) const {
    const Vec3f middle = 0.5f * (g.upper + g.lower), half = 0.5f * (g.upper - g.lower);
    Place place = Place::Inside;
    for (std::uint32_t i = 0; i < umbra.count; ++i) {
      const Plane& plane = planes_[umbra.first + i];
      const float at = glm::dot(plane.n, middle) - plane.d, reach = glm::dot(glm::abs(plane.n), half);
      if (at + reach <= 0) return Place::Outside;
      if (at <= reach) place = Place::Across;
    }
    return place;
  }

  /// `begin` to `end`: of the candidates, the umbras that the parent meets. Its own are taken off again.
  void find(hierarchy::ElementId e, std::size_t begin, std::size_t end) {
    const hierarchy::ElementGeometry& g = elements_.shape(e);
    const std::size_t own = candidates_.size();
    for (std::size_t i = begin; i < end; ++i) {
      const Umbra& umbra = umbras_[candidates_[i]];
      const Place place = placeOf(g, umbra);
      if (place == Place::Inside) {
        hidden_.push_back({e, umbra.occluder});
        candidates_.resize(own);
        return;
      }
      if (place == Place::Across) candidates_.push_back(candidates_[i]);
    }
    const std::size_t ownEnd = candidates_.size();
    if (ownEnd > own && !elements_.isPatch(e))
      for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) find(elements_.child(e, i), own, ownEnd);
    candidates_.resize(own);
  }

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  const Box region_;
  const Vec3 middle_;
  const std::array<Vec3, 8> corners_;
  std::vector<Plane> planes_;
  std::vector<Umbra> umbras_;
  std::vector<std::uint32_t> candidates_;
  std::vector<HiddenElement> hidden_;
  PrimitiveId last_;
  std::uint32_t lastTriangle_ = 0;
};

}  // namespace

std::vector<HiddenElement> hiddenElements(const hierarchy::Elements& elements, const Scene& scene, const Box& region) {
  if (region.empty()) return {};
  return Umbras(elements, scene, region).hidden();
}

}  // namespace deltalux::paper
