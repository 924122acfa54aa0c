#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux {

namespace {

Vec3 areaVector(const Mesh& m, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return 0.5 * glm::cross(m.positions[b] - m.positions[a], m.positions[c] - m.positions[a]);
}

/// Cells along one side of the grid that holds the triangles in pairs.
std::size_t gridSize(const Mesh& m) {
  const std::size_t cells = (m.triangles.size() + 1) / 2;
  auto n = static_cast<std::size_t>(std::sqrt(static_cast<double>(cells)));
  while (n * n < cells) ++n;
  return n;
}

/// A triangle and the weights of its second and third corner.
struct TrianglePoint {
  std::size_t triangle;
  Vec2 weights;
};

/// `triangle` is beyond the mesh's last where the grid is empty.
TrianglePoint locate(const Mesh& m, Vec2 uv) {
  const std::size_t n = gridSize(m);
  const Vec2 scaled = static_cast<double>(n) * uv;
  const auto column = std::min(static_cast<std::size_t>(scaled.x), n - 1);
  const auto row = std::min(static_cast<std::size_t>(scaled.y), n - 1);
  const Vec2 inCell = scaled - Vec2(column, row);
  const std::size_t even = 2 * (row * n + column);
  if (inCell.x + inCell.y <= 1) return {even, inCell};
  return {even + 1, Vec2(1) - inCell};
}

Vec2 parameterOf(const Mesh& m, const TrianglePoint& p) {
  // Kept off the edges of the half cell, beyond which another triangle begins.
  constexpr double margin = 1e-9;
  const Vec3 clamped = glm::max(Vec3(1 - p.weights.x - p.weights.y, p.weights), Vec3(margin));
  const Vec2 weights = Vec2(clamped.y, clamped.z) / (clamped.x + clamped.y + clamped.z);
  const std::size_t n = gridSize(m), cell = p.triangle / 2;
  const Vec2 inCell = p.triangle % 2 == 0 ? weights : Vec2(1) - weights;
  return (Vec2(cell % n, cell / n) + inCell) / static_cast<double>(n);
}

SurfacePoint surfacePoint(const Mesh& m, const TrianglePoint& p, Vec2 uv) {
  const auto& [a, b, c] = m.triangles[p.triangle];
  const Vec3& origin = m.positions[a];
  const Vec3 e1 = m.positions[b] - origin, e2 = m.positions[c] - origin;
  return {origin + p.weights.x * e1 + p.weights.y * e2, glm::normalize(glm::cross(e1, e2)), uv,
          static_cast<std::uint32_t>(p.triangle)};
}

/// Weights of the point of the triangle nearest to `p`, by its Voronoi regions. [Ericson05 5.1.5]
Vec2 nearestWeights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  return Vec2(vb, vc) / (va + vb + vc);
}

}  // namespace

std::optional<Mesh> makeMesh(std::vector<Vec3> positions, std::vector<std::array<std::uint32_t, 3>> triangles,
                             std::vector<Vec3> normals, std::vector<Vec2> texcoords) {
  DELTALUX_CHECK(normals.empty() || normals.size() == positions.size(), "one normal per position");
  DELTALUX_CHECK(texcoords.empty() || texcoords.size() == positions.size(), "one texture coordinate per position");
  Mesh m{std::move(positions), std::move(normals), std::move(texcoords), {}, {}};
  double total = 0;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle)
      DELTALUX_CHECK(corner < m.positions.size(), "index of a triangle out of range");
    const double area = glm::length(areaVector(m, triangle));
    if (!std::isnormal(area * area) || !(total + area > total)) continue;
    total += area;
    m.triangles.push_back(triangle);
    m.cumulativeArea.push_back(total);
  }
  if (m.triangles.empty() || !std::isfinite(total)) return std::nullopt;
  return m;
}

}  // namespace deltalux

namespace deltalux::scene {

namespace kinds {

double area(const Mesh& m) { return m.cumulativeArea.empty() ? 0.0 : m.cumulativeArea.back(); }

Box bounds(const Mesh& m) {
  Box box;
  for (const auto& triangle : m.triangles)
    for (const std::uint32_t corner : triangle) box.extend(m.positions[corner]);
  return box;
}

SurfacePoint pointAt(const Mesh& m, Vec2 uv) {
  TrianglePoint p = locate(m, uv);
  p.triangle = std::min(p.triangle, m.triangles.size() - 1);  // where covers() is false, any point will do
  return surfacePoint(m, p, uv);
}

Vec2 parameterAt(const Mesh& m, const Vec3& p, std::uint32_t triangle) {
  DELTALUX_CHECK(triangle < m.triangles.size(), "no such triangle in the mesh");
  const auto& [a, b, c] = m.triangles[triangle];
  return parameterOf(m, {triangle, nearestWeights(m.positions[a], m.positions[b], m.positions[c], p)});
}

bool covers(const Mesh& m, Vec2 uv) { return locate(m, uv).triangle < m.triangles.size(); }

SurfacePoint samplePoint(const Mesh& m, Vec2 uniform) {
  DELTALUX_CHECK(m.cumulativeArea.size() == m.triangles.size(), "meshes are built by makeMesh");
  const Choice choice = choose(m.cumulativeArea, uniform.x);
  const TrianglePoint p{choice.index, uniformInTriangle({choice.remainder, uniform.y})};
  return surfacePoint(m, p, parameterOf(m, p));
}

namespace {

/// Normals turn with the inverse transpose, written as cofactors so that flattening maps do no harm.
void transformNormals(std::vector<Vec3>& normals, const ShapeMap& map) {
  const glm::dmat3& l = map.linear;
  const glm::dmat3 cofactors(glm::cross(l[1], l[2]), glm::cross(l[2], l[0]), glm::cross(l[0], l[1]));
  for (Vec3& n : normals) {
    const Vec3 turned = (map.mirrors ? -1.0 : 1.0) * (cofactors * n);
    const double length = glm::length(turned);
    if (length > 0) n = turned / length;
  }
}

}  // namespace

std::optional<Shape> transformed(const Mesh& m, const ShapeMap& map) {
  std::vector<Vec3> positions = m.positions, normals = m.normals;
  std::vector<std::array<std::uint32_t, 3>> triangles = m.triangles;
  for (Vec3& p : positions) p = map.point(p);
  transformNormals(normals, map);
  if (map.mirrors)
    for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
  auto mesh = makeMesh(std::move(positions), std::move(triangles), std::move(normals), m.texcoords);
  if (!mesh) return std::nullopt;
  return Shape(std::move(*mesh));
}

}  // namespace kinds

}  // namespace deltalux::scene
