#include "export/overlap.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/parallel.hpp"

namespace deltalux::exporting {

namespace {

constexpr double kLongest = 2;  // of a corner's way, over the width [shown]

using Point = std::tuple<float, float, float>;
Point pointOf(const MeshVertex& v) { return {v.position.x, v.position.y, v.position.z}; }

/// Outward directions of the outline's edges at a point of it.
struct Outward {
  Vec3 sum{0};
  double count = 0;

  void add(const Vec3& n) { sum += n, count += 1; }
  /// So far that each edge moves by 1.
  Vec3 offset() const {
    const double length = glm::length(sum);
    if (!(length > 0)) return Vec3(0);
    const double cosine = std::max(length / count, 1 / kLongest);
    return sum / (length * cosine);
  }
};

void widen(PageMesh& mesh, const PageMesh::Side& side, const SideTriangles& triangles, double width) {
  std::map<std::pair<Point, Point>, std::pair<int, Vec3>> edges;  // how often, and outwards
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a(mesh.vertices[t[k]].position), b(mesh.vertices[t[(k + 1) % 3]].position),
          c(mesh.vertices[t[(k + 2) % 3]].position);
      const Vec3 outward = glm::cross(b - a, glm::cross(b - a, c - a));
      const double length = glm::length(outward);
      auto& edge = edges[std::minmax({pointOf(mesh.vertices[t[k]]), pointOf(mesh.vertices[t[(k + 1) % 3]])})];
      ++edge.first, edge.second = length > 0 ? outward / length : Vec3(0);
    }
  std::map<Point, Outward> points;
  for (const auto& [ends, edge] : edges)
    if (edge.first == 1) points[ends.first].add(edge.second), points[ends.second].add(edge.second);
  for (std::uint32_t v = side.first; v < side.first + side.count; ++v) {
    const auto at = points.find(pointOf(mesh.vertices[v]));
    if (at != points.end()) mesh.vertices[v].position += Vec3f(width * at->second.offset());
  }
}

}  // namespace

void widenSides(PageMesh& mesh, double width) {
  const std::vector<SideTriangles> triangles = trianglesOfSides(mesh);
  parallelFor(mesh.sides.size(), 1, [&](std::size_t s) { widen(mesh, mesh.sides[s], triangles[s], width); });
}

}  // namespace deltalux::exporting
