#include "caustics/mesh_charts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "base/smooth.hpp"
#include "base/tuning.hpp"

namespace deltalux::caustics {

namespace {

Vec3 areaVector(const Mesh& m, std::size_t triangle) {
  const auto& [a, b, c] = m.triangles[triangle];
  return glm::cross(m.positions[b] - m.positions[a], m.positions[c] - m.positions[a]);
}

/// Corners that share a position share a number, whatever their normals and texture coordinates are.
std::vector<std::uint32_t> weldedCorners(const Mesh& m) {
  const auto less = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::map<Vec3, std::uint32_t, decltype(less)> known(less);
  std::vector<std::uint32_t> welded;
  for (const Vec3& p : m.positions)
    welded.push_back(known.emplace(p, static_cast<std::uint32_t>(known.size())).first->second);
  return welded;
}

/// The triangles on the other side of each triangle's three edges; itself where there is none.
std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& m) {
  const std::vector<std::uint32_t> welded = weldedCorners(m);
  struct Edge {
    std::uint32_t low, high, triangle, side;
  };
  std::vector<Edge> edges;
  std::vector<std::array<std::uint32_t, 3>> neighbours(m.triangles.size());
  for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
    neighbours[t] = {t, t, t};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = welded[m.triangles[t][k]], b = welded[m.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Edge &a = edges[i], &b = edges[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    neighbours[a.triangle][a.side] = b.triangle;
    neighbours[b.triangle][b.side] = a.triangle;
    ++i;
  }
  return neighbours;
}

/// The triangles of `members` in their chart's plane.
Chart planeOver(const Mesh& m, const std::vector<std::uint32_t>& members, const Vec3& normal) {
  const Frame frame(normal);
  PlaneChart plane{Vec3(0), frame.tangent, frame.bitangent};
  Vec2 low(kInfinity), high(-kInfinity);
  Vec3 any(0);
  for (const std::uint32_t t : members)
    for (const std::uint32_t corner : m.triangles[t]) {
      any = m.positions[corner];
      const Vec2 at(glm::dot(any, plane.alongS), glm::dot(any, plane.alongT));
      low = glm::min(low, at), high = glm::max(high, at);
    }
  plane.origin = low.x * plane.alongS + low.y * plane.alongT + glm::dot(any, normal) * normal;
  return {plane, high - low};
}

}  // namespace

Charts meshCharts(const Mesh& m) {
  constexpr std::uint32_t none = 0xffffffffu;
  const auto neighbours = neighboursOf(m);
  std::vector<Vec3> normals(m.triangles.size());
  std::vector<double> areas(m.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const Vec3 vector = areaVector(m, t);
    areas[t] = glm::length(vector);
    normals[t] = vector / areas[t];
  }
  std::vector<std::uint32_t> order(m.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return areas[a] > areas[b]; });

  Charts charts;
  charts.ofTriangle.assign(m.triangles.size(), none);
  for (const std::uint32_t seed : order) {
    if (charts.ofTriangle[seed] != none) continue;
    const auto chart = static_cast<std::uint32_t>(charts.all.size());
    std::vector<std::uint32_t> members{seed};
    charts.ofTriangle[seed] = chart;
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const std::uint32_t next : neighbours[members[i]])
        if (charts.ofTriangle[next] == none && glm::dot(normals[next], normals[seed]) > kSmooth) {
          charts.ofTriangle[next] = chart;
          members.push_back(next);
        }
    charts.all.push_back(planeOver(m, members, normals[seed]));
  }
  return charts;
}

}  // namespace deltalux::caustics
