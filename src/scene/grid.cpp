#include <deltalux/grid.hpp>

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <numeric>

namespace deltalux {

namespace {

constexpr double kMostBorder = 0.15;  // of the shorter side [EN12464] [defined]
constexpr double kMostSpacing = 10;   // [m] [EN12464] [defined]
constexpr double kLevel = 0.99;       // cosine to the vertical of what is level [limit]
constexpr int kCylinderSides = 16;    // a small lamp's light is 0.8 % off at most [limit]

/// How many cells no wider than `spacing` a side of such a length has: [EN12464] takes the nearest whole number.
int cellsOf(double length, double spacing) { return std::max(1, static_cast<int>(std::lround(length / spacing))); }

bool holds(const std::vector<Vec2>& outline, const Vec2& p) {
  bool in = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Vec2 &a = outline[i], &b = outline[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

const Polygon& polygonOf(const Scene& scene, std::string_view name) {
  const std::vector<ObjectId> objects = findObjects(scene, name);
  if (objects.empty()) {
    std::vector<std::string> names;
    for (const Object& o : scene.objects) names.push_back(o.name);
    std::string near;
    for (const std::string& n : nearMisses(name, names)) near += (near.empty() ? "" : ", ") + n;
    throw InputError("grid", 0, "there is no object '" + std::string(name) + "'", "nearest: " + near);
  }
  const Polygon* best = nullptr;
  bool bestLevel = false;
  double bestHeight = 0;
  for (const ObjectId object : objects)
    for (const PrimitiveId p : primitivesOf(scene, object)) {
      const auto* polygon = std::get_if<Polygon>(&scene[p].shape);
      if (!polygon || !(polygon->area > 0)) continue;
      const bool level = std::abs(glm::dot(polygon->normal, scene.up)) > kLevel;
      const double height = glm::dot(polygon->vertices.front(), scene.up);
      // Of equal ones, such as a slab's, the upper.
      const double lead = best ? polygon->area / best->area - 1 : 1;
      constexpr double kEqual = 1e-6;  // [rounding]
      const bool larger = lead > kEqual || (std::abs(lead) <= kEqual && height > bestHeight);
      if (!best || (level && !bestLevel) || (level == bestLevel && larger))
        best = polygon, bestLevel = level, bestHeight = height;
    }
  if (!best)
    throw InputError("grid", 0, "'" + std::string(name) + "' has no polygon", "give an area of its own instead");
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
  const double spacing = settings.spacing > 0 ? settings.spacing : gridSpacing(w, d);
  grid.columns = cellsOf(w, spacing), grid.rows = cellsOf(d, spacing);
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

MeasuringGrid gridOn(const Scene& scene, std::string_view object, const GridSettings& settings) {
  const Polygon& polygon = polygonOf(scene, object);
  const std::vector<Vec3>& corners = polygon.vertices;
  const bool level = std::abs(glm::dot(polygon.normal, scene.up)) > kLevel;
  const Vec3 normal = level && glm::dot(polygon.normal, scene.up) < 0 ? -polygon.normal : polygon.normal;
  Vec3 u(0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 edge = corners[(i + 1) % corners.size()] - corners[i];
    if (glm::length(edge) > glm::length(u) * (1 + 1e-9)) u = edge;
  }
  u = glm::normalize(u);
  const Vec3 v = glm::cross(normal, u);
  std::vector<Vec2> outline;
  Vec2 low(1e300), high(-1e300);
  for (const Vec3& p : corners) {
    outline.emplace_back(glm::dot(p - corners[0], u), glm::dot(p - corners[0], v));
    low = glm::min(low, outline.back()), high = glm::max(high, outline.back());
  }
  MeasuringGrid grid = gridOf({corners[0] + low.x * u + low.y * v, (high.x - low.x) * u, (high.y - low.y) * v},
                              scene.metresPerUnit, settings);
  MeasuringGrid on = grid;
  on.points.clear(), on.cells.clear();
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Vec3 from = grid.points[i].position - corners[0];
    if (!holds(outline, {glm::dot(from, u), glm::dot(from, v)})) continue;
    on.points.push_back(grid.points[i]), on.cells.push_back(grid.cells[i]);
  }
  if (on.points.empty())
    throw InputError("grid", 0, "no point of its grid lies on '" + std::string(object) + "'", "set a smaller spacing");
  return on;
}

GridStatistics statisticsOf(std::span<const double> lux) {
  const auto [least, most] = std::ranges::minmax(lux);
  return {std::accumulate(lux.begin(), lux.end(), 0.0) / static_cast<double>(lux.size()), least, most};
}

std::vector<ProbePoint> cylinderAt(const ProbePoint& point, const Vec3& up) {
  const Vec3 axis = glm::normalize(up);
  const Vec3 hint = std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 a = glm::normalize(hint - glm::dot(hint, axis) * axis), b = glm::cross(axis, a);
  std::vector<ProbePoint> all;
  for (int i = 0; i < kCylinderSides; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kCylinderSides;
    all.push_back({point.position, std::cos(angle) * a + std::sin(angle) * b});
  }
  return all;
}

}  // namespace deltalux
