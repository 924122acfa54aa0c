#include "caustics/chart.hpp"

#include <algorithm>

#include "caustics/mesh_charts.hpp"

namespace deltalux::caustics {

namespace {

Charts single(Chart chart) { return {{std::move(chart)}, {}}; }

/// The rectangle around a polygon with sides along `alongS`, which lies in its plane.
Chart rectangleAround(const Polygon& p, const Vec3& alongS) {
  PlaneChart plane;
  plane.alongS = alongS;
  plane.alongT = glm::cross(p.normal, alongS);
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec3& v : p.vertices) {
    const Vec2 at(glm::dot(v - p.origin, plane.alongS), glm::dot(v - p.origin, plane.alongT));
    low = glm::min(low, at), high = glm::max(high, at);
  }
  plane.origin = p.origin + low.x * plane.alongS + low.y * plane.alongT;
  return {plane, high - low};
}

/// The smallest rectangle around a polygon: it has an edge along one of its convex hull's.
Charts chartsOfShape(const Polygon& p) {
  constexpr double kClearly = 0.999;  // smaller than the one found before [rounding]
  Chart smallest = rectangleAround(p, glm::normalize(p.edgeU));
  const std::size_t step = 1 + p.vertices.size() / 64;  // many-sided ones are round
  for (std::size_t i = 0; i < p.vertices.size(); i += step) {
    const Vec3 edge = p.vertices[(i + 1) % p.vertices.size()] - p.vertices[i];
    const Vec3 flat = edge - glm::dot(edge, p.normal) * p.normal;
    if (!(glm::length(flat) > 0)) continue;
    const Chart chart = rectangleAround(p, glm::normalize(flat));
    if (chart.size.x * chart.size.y < kClearly * smallest.size.x * smallest.size.y) smallest = chart;
  }
  return single(smallest);
}

Charts chartsOfShape(const Ring& r) {
  const Frame frame(r.normal);
  const PlaneChart plane{r.center - r.outerRadius * (frame.tangent + frame.bitangent), frame.tangent, frame.bitangent};
  return single({plane, Vec2(2 * r.outerRadius)});
}

Charts chartsOfShape(const Sphere& s) {
  return single({TurnChart{s.radius, 0, true}, {2 * kPi * s.radius, kPi * s.radius}});
}

Charts chartsOfShape(const Cylinder& c) {
  return single({TurnChart{c.radius, 0, false}, {2 * kPi * c.radius, glm::distance(c.p0, c.p1)}});
}

Charts chartsOfShape(const Cone& c) {
  const double side = std::hypot(glm::distance(c.p0, c.p1), c.radius1 - c.radius0);
  const double widest = std::max(c.radius0, c.radius1);
  return single({TurnChart{c.radius0, (c.radius1 - c.radius0) / side, false}, {2 * kPi * widest, side}});
}

Charts chartsOfShape(const Mesh& m) { return meshCharts(m); }

/// The largest radius of a surface of revolution, from its chart's extent.
double widest(const Chart& c) { return c.size.x / (2 * kPi); }

}  // namespace

Charts chartsOf(const Shape& shape) {
  return std::visit([](const auto& s) { return chartsOfShape(s); }, shape);
}

double Chart::stretch(double t) const {
  const auto* turn = std::get_if<TurnChart>(&map);
  return turn ? std::max(turn->radiusAt(std::clamp(t, 0.0, size.y)), 0.0) / widest(*this) : 1.0;
}

double Chart::bandArea(double t0, double t1) const {
  const auto* turn = std::get_if<TurnChart>(&map);
  if (!turn) return t1 - t0;
  if (!turn->sphere) return 0.5 * (stretch(t0) + stretch(t1)) * (t1 - t0);
  const double r = turn->radius0;
  return r * (std::cos(t0 / r) - std::cos(t1 / r));
}

Vec2 Chart::place(const SurfacePoint& p) const {
  if (const auto* plane = std::get_if<PlaneChart>(&map)) {
    const Vec3 d = p.position - plane->origin;
    return {glm::dot(d, plane->alongS), glm::dot(d, plane->alongT)};
  }
  const TurnChart& turn = std::get<TurnChart>(map);
  const double t = turn.sphere ? turn.radius0 * std::acos(std::clamp(1 - 2 * p.uv.y, -1.0, 1.0)) : p.uv.y * size.y;
  return {p.uv.x * size.x, t};
}

SurfacePoint impactPoint(const Shape& shape, const glm::vec2& uv, std::uint32_t triangle) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return pointAt(shape, Vec2(uv));
  const auto& [a, b, c] = mesh->triangles[triangle];
  const Vec3& origin = mesh->positions[a];
  SurfacePoint point;
  point.position = origin + double(uv.x) * (mesh->positions[b] - origin) + double(uv.y) * (mesh->positions[c] - origin);
  point.uv = Vec2(uv);
  point.triangle = triangle;
  return point;
}

}  // namespace deltalux::caustics
