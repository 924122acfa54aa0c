#include <deltalux/grid.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <numeric>

#include "scene/edit/plan.hpp"

namespace deltalux {

namespace {

constexpr double kMostBorder = 0.15;  // of the shorter side [EN12464] [defined]
constexpr double kMostSpacing = 10;   // [m] [EN12464] [defined]
constexpr double kLevel = 0.99;       // cosine to the vertical of what is level [limit]
constexpr double kRounding = 1e-4;    // of a cell: what single precision leaves too many [rounding]
constexpr int kMostPoints = 1000000;  // more are a mistake of units [limit]
constexpr int kDiscCorners = 64;      // of a disc as a polygon: 0.2 % of its area is left out [limit]
constexpr int kCylinderSides = 16;    // a small lamp's light is 0.8 % off at most [limit]

/// Along two sides.
struct Cells {
  int columns, rows;
};
/// By the standard's spacing the nearest whole number [EN12464]; otherwise cells are no wider than is asked for.
Cells cellsOf(double width, double depth, double asked) {
  const double spacing = asked > 0 ? asked : gridSpacing(width, depth);
  const auto count = [&](double length) {
    return std::max(asked > 0 ? std::ceil(length / spacing - kRounding) : std::round(length / spacing), 1.0);
  };
  const double columns = count(width), rows = count(depth);
  if (!(columns * rows <= kMostPoints))
    throw InputError(
        "", 0, fmt::format("a grid of {:.3g} by {:.3g} points is more than {} points", columns, rows, kMostPoints),
        "use a larger spacing");
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

/// A polygon, or a disc as one of many corners; nullopt of all else.
std::optional<Polygon> flatShape(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return *polygon;
  const auto* ring = std::get_if<Ring>(&shape);
  if (!ring || ring->innerRadius > 0 || !(ring->outerRadius > 0)) return std::nullopt;
  const Frame frame(ring->normal);
  std::vector<Vec3> corners;
  for (int i = 0; i < kDiscCorners; ++i) {
    const double angle = 2 * kPi * (i - 0.5) / kDiscCorners - kPi / 2;  // the first edge lies along the tangent
    corners.push_back(ring->center + ring->outerRadius * frame.toWorld({std::cos(angle), std::sin(angle), 0}));
  }
  return makePolygon(std::move(corners));
}

Polygon polygonOf(const Scene& scene, std::string_view name) {
  std::optional<Polygon> best;
  bool bestLevel = false;
  double bestHeight = 0;
  for (const ObjectId object : scene::edits::objectsNamed(scene, std::string(name)))
    for (const PrimitiveId p : primitivesOf(scene, object)) {
      std::optional<Polygon> polygon = flatShape(scene[p].shape);
      if (!polygon || !(polygon->area > 0)) continue;
      const bool level = std::abs(glm::dot(polygon->normal, scene.up)) > kLevel;
      const double height = glm::dot(polygon->vertices.front(), scene.up);
      // Of equal ones, such as a slab's, the upper.
      const double lead = best ? polygon->area / best->area - 1 : 1;
      constexpr double kEqual = 1e-6;  // [rounding]
      const bool larger = lead > kEqual || (std::abs(lead) <= kEqual && height > bestHeight);
      if (!best || (level && !bestLevel) || (level == bestLevel && larger))
        best = std::move(polygon), bestLevel = level, bestHeight = height;
    }
  if (!best)
    scene::edits::refuse("'" + std::string(name) + "' has no polygon and no disc", "give an area of its own instead");
  return *best;
}

}  // namespace

double gridSpacing(double side, double otherSide) {
  const double longer = std::max(side, otherSide), shorter = std::min(side, otherSide);
  const double d = longer >= 2 * shorter ? shorter : longer;
  return std::min(0.2 * std::pow(5.0, std::log10(d)), kMostSpacing);  // [EN12464]
}

MeasuringGrid gridOf(const GridArea& area, double metresPerUnit, const GridSettings& settings) {
  const double width = glm::length(area.u) * metresPerUnit, depth = glm::length(area.v) * metresPerUnit;
  const double border = std::min(settings.border, kMostBorder * std::min(width, depth));
  MeasuringGrid grid;
  const Vec3 normal = glm::normalize(glm::cross(area.u, area.v));
  const double inU = border / width, inV = border / depth;
  grid.area.corner = area.corner + inU * area.u + inV * area.v;
  grid.area.u = (1 - 2 * inU) * area.u, grid.area.v = (1 - 2 * inV) * area.v;
  const double w = width - 2 * border, d = depth - 2 * border;
  const auto [columns, rows] = cellsOf(w, d, settings.spacing);
  grid.columns = columns, grid.rows = rows;
  const Vec3 up = settings.height / metresPerUnit * normal;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      grid.points.push_back(
          {grid.area.corner + (column + 0.5) / grid.columns * grid.area.u + (row + 0.5) / grid.rows * grid.area.v + up,
           normal});
      grid.cells.push_back(grid.cells.size());
    }
  return grid;
}

namespace {

/// Without points where none lies on the polygon.
MeasuringGrid gridOnPolygon(const Polygon& polygon, const Vec3& up, double metresPerUnit,
                            const GridSettings& settings) {
  const std::vector<Vec3>& corners = polygon.vertices;
  const bool level = std::abs(glm::dot(polygon.normal, up)) > kLevel;
  const Vec3 normal = level && glm::dot(polygon.normal, up) < 0 ? -polygon.normal : polygon.normal;
  Vec3 u(0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 edge = corners[(i + 1) % corners.size()] - corners[i];
    if (glm::length(edge) > glm::length(u) * (1 + 1e-9)) u = edge;
  }
  u = glm::normalize(u);
  const Vec3 v = glm::cross(normal, u);
  Vec2 low(0.0), high(0.0);
  for (const Vec3& p : corners) {
    const Vec2 at(glm::dot(p - corners[0], u), glm::dot(p - corners[0], v));
    low = glm::min(low, at), high = glm::max(high, at);
  }
  MeasuringGrid grid =
      gridOf({corners[0] + low.x * u + low.y * v, (high.x - low.x) * u, (high.y - low.y) * v}, metresPerUnit, settings);
  MeasuringGrid on = grid;
  on.points.clear(), on.cells.clear();
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Vec3 from = grid.points[i].position - polygon.origin;
    const Vec2 uv(glm::dot(from, polygon.dualU), glm::dot(from, polygon.dualV));
    const bool inFrame = std::min(uv.x, uv.y) >= 0 && std::max(uv.x, uv.y) <= 1;  // which covers() takes for granted
    if (!inFrame || !covers(polygon, uv)) continue;
    on.points.push_back(grid.points[i]), on.cells.push_back(grid.cells[i]);
  }
  return on;
}

}  // namespace

MeasuringGrid gridOn(const Scene& scene, std::string_view object, const GridSettings& settings) {
  const MeasuringGrid grid = gridOnPolygon(polygonOf(scene, object), scene.up, scene.metresPerUnit, settings);
  if (grid.points.empty())
    scene::edits::refuse("no point of its grid lies on '" + std::string(object) + "'", "set a smaller spacing");
  return grid;
}

MeasuringGrid gridOn(const Polygon& polygon, const Vec3& up, double metresPerUnit, const GridSettings& settings) {
  MeasuringGrid grid = gridOnPolygon(polygon, up, metresPerUnit, settings);
  if (grid.points.empty()) scene::edits::refuse("no point of its grid lies on the polygon", "set a smaller spacing");
  return grid;
}

GridStatistics statisticsOf(std::span<const double> lux) {
  const auto [least, most] = std::ranges::minmax(lux);
  return {std::accumulate(lux.begin(), lux.end(), 0.0) / static_cast<double>(lux.size()), least, most};
}

std::vector<ProbePoint> cylinderAt(const ProbePoint& point, const Vec3& up) {
  const Frame frame(glm::normalize(up));
  std::vector<ProbePoint> all;
  for (int i = 0; i < kCylinderSides; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kCylinderSides;
    all.push_back({point.position, frame.toWorld({std::cos(angle), std::sin(angle), 0})});
  }
  return all;
}

}  // namespace deltalux
