#include "export/atlas_charts.hpp"

#include <numeric>

#include "base/box_tree.hpp"
#include "export/atlas_regions.hpp"

namespace deltalux::exporting {

namespace {

constexpr double kTouch = 1e-5;  // of a chart's size: triangles that share less do not overlap [rounding]

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Corners of the convex hull, counter-clockwise. Cost: n log n.
std::vector<Vec2> hullOf(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (const bool upper : {false, true}) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
    if (upper) break;
  }
  return hull;
}

/// The direction along which the box around the points has the least area: that of an edge of their hull.
Vec2 tightestDirection(const std::vector<Vec2>& points) {
  const std::vector<Vec2> hull = hullOf(points);
  Vec2 best(1, 0);
  double least = kInfinity;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    const double length = glm::length(edge);
    if (!(length > 0)) continue;
    const Vec2 along = edge / length;
    Vec2 low(kInfinity), high(-kInfinity);
    for (const Vec2& p : hull) {
      const Vec2 q(glm::dot(p, along), cross(along, p));
      low = glm::min(low, q), high = glm::max(high, q);
    }
    const double area = (high.x - low.x) * (high.y - low.y);
    if (area < least * (1 - kTouch)) least = area, best = along;
  }
  return best;
}

/// The chart of some triangles, without places.
AtlasChart chartWith(const SurfaceMesh& side, std::vector<std::uint32_t> triangles) {
  AtlasChart chart;
  chart.side = static_cast<std::uint32_t>(SolutionMesh::side(side.primitive, side.front));
  std::sort(triangles.begin(), triangles.end());
  chart.triangles = std::move(triangles);
  for (const std::uint32_t t : chart.triangles)
    chart.vertices.insert(chart.vertices.end(), &side.triangles[3 * t], &side.triangles[3 * t] + 3);
  chart.corners = chart.vertices;
  std::sort(chart.vertices.begin(), chart.vertices.end());
  chart.vertices.erase(std::unique(chart.vertices.begin(), chart.vertices.end()), chart.vertices.end());
  for (std::uint32_t& c : chart.corners)
    c = static_cast<std::uint32_t>(std::lower_bound(chart.vertices.begin(), chart.vertices.end(), c) -
                                   chart.vertices.begin());
  return chart;
}

void moveToOrigin(AtlasChart& chart) {
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec2& p : chart.places) low = glm::min(low, p), high = glm::max(high, p);
  for (Vec2& p : chart.places) p -= low;
  chart.size = high - low;
}

AtlasChart projected(const SurfaceMesh& side, std::vector<std::uint32_t> triangles) {
  AtlasChart chart = chartWith(side, std::move(triangles));
  Vec3 sum(0);
  for (const std::uint32_t t : chart.triangles) sum += areaNormal(side, t);
  const double length = glm::length(sum);
  const Frame frame(length > 0 ? sum / length : Vec3(side.vertices[chart.vertices.front()].normal));
  const Vec3 middle(side.vertices[chart.vertices.front()].position);
  for (const std::uint32_t v : chart.vertices)
    chart.places.emplace_back(frame.toLocal(Vec3(side.vertices[v].position) - middle));
  const Vec2 along = tightestDirection(chart.places);
  for (Vec2& p : chart.places) p = Vec2(glm::dot(p, along), cross(along, p));
  moveToOrigin(chart);
  return chart;
}

/// Where the parameters of a curved shape lie when it is unrolled; spheres by their angles.
Vec2 unrolled(const Shape& shape, const Vec2& uv) {
  if (const auto* s = std::get_if<Sphere>(&shape))
    return s->radius * Vec2(2 * kPi * uv.x, std::acos(std::clamp(2 * uv.y - 1, -1.0, 1.0)));
  if (const auto* c = std::get_if<Cylinder>(&shape))
    return {2 * kPi * c->radius * uv.x, glm::length(c->p1 - c->p0) * uv.y};
  const auto& c = std::get<Cone>(shape);
  return {2 * kPi * std::max(c.radius0, c.radius1) * uv.x,
          std::hypot(glm::length(c.p1 - c.p0), c.radius1 - c.radius0) * uv.y};
}

AtlasChart unrolledChart(const SurfaceMesh& side, const Shape& shape, std::vector<std::uint32_t> triangles) {
  AtlasChart chart = chartWith(side, std::move(triangles));
  for (const std::uint32_t v : chart.vertices) chart.places.push_back(unrolled(shape, Vec2(side.vertices[v].uv)));
  moveToOrigin(chart);
  return chart;
}

void addProjected(std::vector<AtlasChart>& to, const SurfaceMesh& side, const std::vector<std::uint32_t>& triangles,
                  double crease) {
  for (std::vector<std::uint32_t>& region : regionsOf(side, triangles, crease)) {
    AtlasChart chart = projected(side, region);
    if (!coversItself(chart)) {
      to.push_back(std::move(chart));
    } else if (crease > kTouch) {
      addProjected(to, side, region, kTouch);
    } else {
      for (const std::uint32_t t : region) to.push_back(projected(side, {t}));
    }
  }
}

struct FlatTriangle {
  std::array<Vec2, 3> corners;

  /// How far it reaches along a direction.
  std::pair<double, double> extent(const Vec2& direction) const {
    const auto [a, b, c] = corners;
    const double x = glm::dot(a, direction), y = glm::dot(b, direction), z = glm::dot(c, direction);
    return {std::min({x, y, z}), std::max({x, y, z})};
  }
};

/// Whether some line parts them but for `touch`.
bool separated(const FlatTriangle& a, const FlatTriangle& b, double touch) {
  for (const FlatTriangle* t : {&a, &b})
    for (int i = 0; i < 3; ++i) {
      const Vec2 edge = t->corners[(i + 1) % 3] - t->corners[i];
      const double length = glm::length(edge);
      if (!(length > 0)) return true;  // without area
      const Vec2 across = Vec2(-edge.y, edge.x) / length;
      const auto [lowA, highA] = a.extent(across);
      const auto [lowB, highB] = b.extent(across);
      if (std::min(highA, highB) - std::max(lowA, lowB) <= touch) return true;
    }
  return false;
}

}  // namespace

bool coversItself(const AtlasChart& chart) {
  std::vector<FlatTriangle> all;
  std::vector<BoxF> boxes;
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    FlatTriangle triangle;
    BoxF box;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = chart.places[chart.corners[3 * t + k]];
      box.extend(Vec3f(Vec3(triangle.corners[k], 0)));
    }
    all.push_back(triangle), boxes.push_back(box);
  }
  const double touch = kTouch * glm::length(chart.size);
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    bool found = false;
    tree.overlapping(boxes[i], [&](std::uint32_t j) { found = found || (j > i && !separated(all[i], all[j], touch)); });
    if (found) return true;
  }
  return false;
}

std::vector<AtlasChart> chartsOf(const SurfaceMesh& side, const Shape& shape, double crease) {
  std::vector<AtlasChart> charts;
  std::vector<std::uint32_t> all(side.triangles.size() / 3);
  std::iota(all.begin(), all.end(), 0u);
  if (all.empty()) return charts;
  const bool curved = std::holds_alternative<Sphere>(shape) || std::holds_alternative<Cylinder>(shape) ||
                      std::holds_alternative<Cone>(shape);
  if (curved) {
    charts.push_back(unrolledChart(side, shape, std::move(all)));
  } else if (std::holds_alternative<Mesh>(shape)) {
    addProjected(charts, side, all, crease);
  } else if (charts.push_back(projected(side, all)); coversItself(charts.back())) {
    charts.clear();
    for (const std::uint32_t t : all) charts.push_back(projected(side, {t}));
  }
  return charts;
}

}  // namespace deltalux::exporting
