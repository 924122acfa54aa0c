#include <algorithm>

#include "scene/flat_outline.hpp"
#include "scene/hole_winding.hpp"
#include "scene/shape_kinds.hpp"
#include "scene/triangulation.hpp"

namespace deltalux {

namespace {

constexpr double kPlanarity = 1e-3;      // of the size: beyond, there is no plane [limit]
constexpr double kFlatEnough = 1e-9;     // of the size: within, vertices stay where they are [rounding]
constexpr double kParallelogram = 1e-6;  // of the size: as numbers printed with seven digits leave it [rounding]

double sizeOf(const std::vector<Vec3>& vertices) {
  Box box;
  for (const Vec3& v : vertices) box.extend(v);
  return box.diagonal();
}

double largestCoordinate(const std::vector<Vec3>& vertices) {
  double largest = 0;
  for (const Vec3& v : vertices) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest;
}

void dropRepeatedVertices(std::vector<Vec3>& vertices) {
  const double tolerance = 1e-12 * sizeOf(vertices);
  const auto same = [&](const Vec3& a, const Vec3& b) { return glm::distance(a, b) <= tolerance; };
  vertices.erase(std::unique(vertices.begin(), vertices.end(), same), vertices.end());
  while (vertices.size() > 1 && same(vertices.front(), vertices.back())) vertices.pop_back();
}

/// The unit normal, with the vertices brought into the plane through their mean. nullopt without area or plane.
std::optional<Vec3> flatten(std::vector<Vec3>& vertices) {
  const double size = sizeOf(vertices);
  const Vec3 newell = scene::newellVector(vertices);
  const double area = glm::length(newell);
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * largestCoordinate(vertices) * size;
  if (!std::isfinite(area) || !(area > 1e-12 * size * size + rounding)) return std::nullopt;
  const Vec3 normal = newell / area;

  Vec3 mean(0);
  for (const Vec3& v : vertices) mean += (v - vertices[0]) / static_cast<double>(vertices.size());
  mean += vertices[0];
  double deviation = 0;
  for (const Vec3& v : vertices) deviation = std::max(deviation, std::abs(glm::dot(v - mean, normal)));
  if (deviation > kPlanarity * size) return std::nullopt;
  if (deviation > kFlatEnough * size)
    for (Vec3& v : vertices) v -= glm::dot(v - mean, normal) * normal;
  return normal;
}

/// Vertices where the outline turns.
std::vector<Vec3> cornersOf(const std::vector<Vec3>& vertices) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0, n = vertices.size(); i < n; ++i) {
    const Vec3 in = vertices[i] - vertices[(i + n - 1) % n], out = vertices[(i + 1) % n] - vertices[i];
    const double straight = 1e-9 * glm::length(in) * glm::length(out);
    if (glm::dot(in, out) <= 0 || glm::length(glm::cross(in, out)) > straight) corners.push_back(vertices[i]);
  }
  return corners;
}

bool frameParallelogram(Polygon& p) {
  const std::vector<Vec3> corners = cornersOf(p.vertices);
  if (corners.size() != 4) return false;
  const Vec3 gap = corners[0] - corners[1] + corners[2] - corners[3];
  if (glm::length(gap) > kParallelogram * sizeOf(p.vertices)) return false;
  p.origin = corners[0], p.edgeU = corners[1] - corners[0], p.edgeV = corners[3] - corners[0];
  return glm::dot(glm::cross(p.edgeU, p.edgeV), p.normal) > 0;
}

void frameRectangle(Polygon& p) {
  Vec3 longest(0);
  for (std::size_t i = 0, n = p.vertices.size(); i < n; ++i) {
    const Vec3 edge = p.vertices[(i + 1) % n] - p.vertices[i];
    // The first of equally long edges, also after a motion has rounded their lengths apart.
    if (glm::dot(edge, edge) > (1 + 1e-9) * glm::dot(longest, longest)) longest = edge;
  }
  const Vec3 across = glm::normalize(glm::cross(p.normal, longest)), along = glm::cross(across, p.normal);
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec3& v : p.vertices) {
    const Vec2 local(glm::dot(v - p.vertices[0], along), glm::dot(v - p.vertices[0], across));
    low = glm::min(low, local), high = glm::max(high, local);
  }
  p.origin = p.vertices[0] + low.x * along + low.y * across;
  p.edgeU = (high.x - low.x) * along;
  p.edgeV = (high.y - low.y) * across;
}

/// Everything that follows from vertices, normal, frame and triangles.
void fillTables(Polygon& p) {
  const Vec3 cross = glm::cross(p.edgeU, p.edgeV);
  const double squared = glm::dot(cross, cross);
  p.dualU = glm::cross(p.edgeV, cross) / squared;
  p.dualV = glm::cross(cross, p.edgeU) / squared;
  p.outline.clear(), p.cumulativeArea.clear(), p.area = 0;
  for (const Vec3& v : p.vertices) p.outline.push_back(scene::kinds::parameterAt(p, v));
  for (const auto& [a, b, c] : p.triangles) {
    p.area += 0.5 * glm::length(glm::cross(p.vertices[b] - p.vertices[a], p.vertices[c] - p.vertices[a]));
    p.cumulativeArea.push_back(p.area);
  }
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

std::optional<Polygon> makePolygon(std::vector<Vec3> vertices) {
  dropRepeatedVertices(vertices);
  if (vertices.size() < 3) return std::nullopt;
  const auto normal = flatten(vertices);
  if (!normal) return std::nullopt;
  Polygon p;
  p.vertices = scene::inOrder(vertices, scene::windingOrder(vertices));
  p.normal = *normal;
  p.triangles = scene::triangulate(scene::flatOutline(p.vertices, p.normal));
  if (p.triangles.empty()) return std::nullopt;
  p.fillsFrame = frameParallelogram(p);
  if (!p.fillsFrame) frameRectangle(p);
  fillTables(p);
  return p;
}

}  // namespace deltalux

namespace deltalux::scene {

namespace kinds {

double area(const Polygon& p) { return p.area; }

Box bounds(const Polygon& p) {
  Box box;
  for (const Vec3& v : p.vertices) box.extend(v);
  return box;
}

SurfacePoint pointAt(const Polygon& p, Vec2 uv) { return {p.origin + uv.x * p.edgeU + uv.y * p.edgeV, p.normal, uv}; }

Vec2 parameterAt(const Polygon& p, const Vec3& at) {
  const Vec3 d = at - p.origin;
  return glm::clamp(Vec2(glm::dot(d, p.dualU), glm::dot(d, p.dualV)), 0.0, 1.0);
}

bool covers(const Polygon& p, Vec2 uv) {
  if (p.fillsFrame) return true;
  constexpr double edge = -1e-12;  // the outline itself is covered
  return std::any_of(p.triangles.begin(), p.triangles.end(), [&](const auto& triangle) {
    const Vec2 &a = p.outline[triangle[0]], &b = p.outline[triangle[1]], &c = p.outline[triangle[2]];
    return turn(a, b, uv) >= edge && turn(b, c, uv) >= edge && turn(c, a, uv) >= edge;
  });
}

SurfacePoint samplePoint(const Polygon& p, Vec2 uniform) {
  if (p.fillsFrame) return pointAt(p, uniform);
  const Choice choice = choose(p.cumulativeArea, uniform.x);
  const Vec2 w = uniformInTriangle({choice.remainder, uniform.y});
  const std::array<std::uint32_t, 3>& corners = p.triangles[choice.index];
  const auto mix = [&](const auto& table) {
    const auto &a = table[corners[0]], &b = table[corners[1]], &c = table[corners[2]];
    return a + w.x * (b - a) + w.y * (c - a);
  };
  return {mix(p.vertices), p.normal, mix(p.outline)};
}

std::optional<Shape> transformed(const Polygon& p, const ShapeMap& map) {
  std::vector<Vec3> vertices = p.vertices;
  for (Vec3& v : vertices) v = map.point(v);
  if (map.mirrors) std::reverse(vertices.begin(), vertices.end());
  auto fresh = makePolygon(std::move(vertices));
  if (!fresh) return std::nullopt;
  if (!map.mirrors && fresh->vertices.size() == p.vertices.size()) {
    // Its parameters move along, so that what is known by them (patches, textures) stays where it was on the surface.
    fresh->origin = map.point(p.origin);
    fresh->edgeU = map.point(p.origin + p.edgeU) - fresh->origin;
    fresh->edgeV = map.point(p.origin + p.edgeV) - fresh->origin;
    fresh->triangles = p.triangles;
    fresh->fillsFrame = p.fillsFrame;
    fillTables(*fresh);
  }
  return Shape(std::move(*fresh));
}

}  // namespace kinds

}  // namespace deltalux::scene
