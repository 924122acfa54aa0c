#include "hierarchy/contact_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include "base/box_tree.hpp"
#include "base/smooth.hpp"
#include "base/tuning.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/element.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/plane_points.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/edit/plan.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr double kTogether = 1e-6;  // lines that are closer count as one [rounding]

/// A flat face of a surface that stops light.
struct Face {
  std::vector<Vec3> corners;
  Vec3 normal;
};

BoxF around(std::span<const Vec3> points, double slack) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  const double by = slack * box.diagonal();
  return {Vec3f(box.lower - by), Vec3f(box.upper + by)};
}

bool isPlane(const Elements& elements, ElementId patch) {
  return elements.at(patch).flat || (elements.hasFaces(patch) && elements.shape(patch).normalCone >= 1);
}

/// Input-level patches below the scene's root that have a plane, of one face or of many.
std::vector<ElementId> planeInputs(const Elements& elements) {
  std::vector<ElementId> planes;
  if (!elements.sceneRoot.valid()) return planes;
  forEachBelow(elements, elements.sceneRoot, [&](ElementId e) {
    if (elements.isInputLevel(e) && isPlane(elements, e)) planes.push_back(e);
    return elements.isCluster(e);
  });
  return planes;
}

/// A patch's outline in space, with everything at rest.
std::vector<Vec3> cornersOf(const Elements& elements, const PlaneFrame& plane, ElementId patch) {
  std::vector<Vec3> corners;
  for (const Vec2& q : elements.outline(patch)) corners.push_back(plane.at(q));
  return corners;
}

/// Of a plane patch of many faces: of the rectangle along its first face's edge that holds it.
std::vector<Vec3> cornersAround(const Elements& elements, const Mesh& atRest, PlaneFrame plane, ElementId patch) {
  plane.edgeU = glm::normalize(plane.edgeU), plane.edgeV = glm::cross(plane.normal, plane.edgeU);
  const PlanePoints points(plane);
  Vec2 low(kInfinity), high(-kInfinity);
  const FaceRange range = elements.facesOf(patch);
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
    for (const std::uint32_t corner : atRest.triangles[elements.orderOf(patch).faceAt(i)]) {
      const Vec2 q = points.of(atRest.positions[corner]);
      low = glm::min(low, q), high = glm::max(high, q);
    }
  return {plane.at(low), plane.at({high.x, low.y}), plane.at(high), plane.at({low.x, high.y})};
}

}  // namespace

class ContactLines::Search {
 public:
  Search(const Elements& elements, const Scene& scene, std::span<const ElementId> inputs)
      : elements_(elements), scene_(scene), faces_(facesOf(inputs)), tree_(boxesOf(faces_)) {}

  /// The lines on a patch that stand across u, and across v.
  std::array<std::vector<Line>, 2> on(ElementId patch) const {
    std::array<std::vector<Line>, 2> lines;
    const auto plane = atRest(patch);
    if (!plane) return lines;
    const PlanePoints points(*plane);
    const Vec3 up = elements_.at(patch).front ? plane->normal : -plane->normal;
    tree_.overlapping(around(cornersOf(elements_, *plane, patch), 1e-4),
                      [&](std::uint32_t face) { addFoot(faces_[face], *plane, points, up, lines); });
    for (auto& across : lines) align(across);
    return lines;
  }

 private:
  std::optional<PlaneFrame> atRest(ElementId patch) const {
    const PatchDomain& d = elements_.domain[patch.index()];
    return planeOf(scene::edits::restShape(scene_, d.primitive), d.triangle);
  }

  std::vector<Face> facesOf(std::span<const ElementId> inputs) const {
    std::vector<Face> faces;
    for (const ElementId e : inputs) {
      const Side side = elements_.sideOf(e);
      const bool again = !side.front && elements_.sides.at({side.primitive, side.triangle, true}).valid();
      if (again || !scene::stopsLight(scene_.materialOf(side.primitive))) continue;
      const auto plane = atRest(e);
      if (!plane) continue;
      if (!elements_.hasFaces(e)) {
        faces.push_back({cornersOf(elements_, *plane, e), plane->normal});
        continue;
      }
      const auto& mesh = std::get<Mesh>(scene::edits::restShape(scene_, side.primitive));
      faces.push_back({cornersAround(elements_, mesh, *plane, e), plane->normal});
    }
    return faces;
  }

  static std::vector<BoxF> boxesOf(const std::vector<Face>& faces) {
    std::vector<BoxF> boxes;
    for (const Face& f : faces) boxes.push_back(around(f.corners, tuning::kTouching));
    return boxes;
  }

  /// Adds where a face meets the plane, if it rises from it to the side of `up`.
  static void addFoot(const Face& face, const PlaneFrame& plane, const PlanePoints& points, const Vec3& up,
                      std::array<std::vector<Line>, 2>& lines) {
    if (std::abs(glm::dot(face.normal, up)) > kSmooth) return;
    const auto heightOf = [&](const Vec3& p) { return glm::dot(p - plane.origin, up); };
    double height = 0;
    for (const Vec3& p : face.corners) height = std::max(height, heightOf(p));
    const double close = tuning::kTouching * height;
    Vec2 lower(kInfinity), upper(-kInfinity);
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const Vec3 &a = face.corners[i], &b = face.corners[(i + 1) % face.corners.size()];
      const double ha = heightOf(a), rise = heightOf(b) - ha;
      // The part of the edge that lies in the slab |h| <= close.
      double from = 0, to = 1;
      if (rise != 0) {
        const auto [first, last] = std::minmax({(-close - ha) / rise, (close - ha) / rise});
        from = std::max(first, 0.0), to = std::min(last, 1.0);
      } else if (std::abs(ha) > close) {
        continue;
      }
      if (from > to) continue;
      for (const double at : {from, to}) {
        const Vec2 q = points.of(a + at * (b - a));
        lower = glm::min(lower, q), upper = glm::max(upper, q);
      }
    }
    const Vec2 size(glm::length(plane.edgeU), glm::length(plane.edgeV));
    for (const int axis : {0, 1}) {
      const int along = 1 - axis;
      const double at = 0.5 * (lower[axis] + upper[axis]);
      const double from = std::max(lower[along], 0.0), to = std::min(upper[along], 1.0);
      const double strays = (upper[axis] - lower[axis]) * size[axis];
      if (at > 0 && at < 1 && to - from >= tuning::kTouching &&
          strays <= tuning::kTouching * (upper[along] - lower[along]) * size[along])
        lines[static_cast<std::size_t>(axis)].push_back(
            {static_cast<float>(at), static_cast<float>(from), static_cast<float>(to), static_cast<float>(height)});
    }
  }

  /// Sorts lines, and puts those on one that are almost.
  static void align(std::vector<Line>& lines) {
    std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
      return std::tie(a.at, a.from, a.to, a.height) < std::tie(b.at, b.from, b.to, b.height);
    });
    for (std::size_t i = 1; i < lines.size(); ++i)
      if (lines[i].at - lines[i - 1].at < kTogether) lines[i].at = lines[i - 1].at;
  }

  const Elements& elements_;
  const Scene& scene_;
  std::vector<Face> faces_;
  BoxTree tree_;
};

ContactLines::ContactLines(const Elements& elements, const Scene& scene) {
  const std::vector<ElementId> inputs = planeInputs(elements);
  const Search search(elements, scene, inputs);
  std::vector<ElementId> patchOf(elements.frames.size());
  for (const ElementId e : inputs)
    if (elements.at(e).flat) patchOf[elements.domain[e.index()].frame] = e;
  for (const ElementId patch : patchOf) {
    const auto found = patch.valid() ? search.on(patch) : std::array<std::vector<Line>, 2>();
    for (const auto& across : found) {
      lines_.insert(lines_.end(), across.begin(), across.end());
      end_.push_back(static_cast<std::uint32_t>(lines_.size()));
    }
  }
}

std::optional<float> ContactLines::across(const Range& r, float height) const {
  const std::size_t i = 2 * std::size_t(r.plane) + static_cast<std::size_t>(r.axis);
  if (i >= end_.size()) return std::nullopt;  // a surface that an edit has brought into the light
  const float margin = static_cast<float>(tuning::kTouching) * (r.to - r.from), middle = 0.5f * (r.from + r.to);
  const auto last = lines_.begin() + end_[i];
  auto line = std::lower_bound(lines_.begin() + (i > 0 ? end_[i - 1] : 0), last, r.from + margin,
                               [](const Line& l, float at) { return l.at < at; });
  std::optional<float> nearest;
  while (line != last && line->at <= r.to - margin) {
    const float at = line->at;
    float crossed = 0;
    for (; line != last && line->at == at; ++line)
      if (line->height >= height) crossed += std::max(0.0f, std::min(line->to, r.high) - std::max(line->from, r.low));
    if (2 * crossed < r.high - r.low) continue;
    if (!nearest || std::abs(at - middle) < std::abs(*nearest - middle)) nearest = at;
  }
  return nearest;
}

std::size_t ContactLines::memoryBytes() const {
  return lines_.capacity() * sizeof(lines_[0]) + end_.capacity() * sizeof(end_[0]);
}

}  // namespace deltalux::hierarchy
