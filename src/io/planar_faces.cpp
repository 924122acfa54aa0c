#include "io/planar_faces.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "hierarchy/tuning.hpp"

namespace deltalux::io {

namespace {

// Relative to the mesh's size, and in the sines of angles: what single precision leaves of a plane.
constexpr double kFlat = 1e-6;  // [rounding]

using FaceCorners = std::array<std::uint32_t, 3>;

// The same mesh with one vertex per place, so that neighbours share indices.
std::vector<FaceCorners> weldedTriangles(const Mesh& mesh) {
  const auto before = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::map<Vec3, std::uint32_t, decltype(before)> places(before);
  std::vector<FaceCorners> triangles = mesh.triangles;
  for (FaceCorners& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = places.try_emplace(mesh.positions[corner], corner).first->second;
  }
  return triangles;
}

Vec3 scaledNormal(const Mesh& mesh, const FaceCorners& t) {
  return glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
}

bool isFlatShaded(const Mesh& mesh) {
  if (mesh.normals.empty()) return true;
  for (const FaceCorners& triangle : mesh.triangles) {
    const Vec3 normal = glm::normalize(scaledNormal(mesh, triangle));
    for (const std::uint32_t corner : triangle) {
      if (glm::dot(normal, mesh.normals[corner]) < 1 - 1e-4) return false;
    }
  }
  return true;
}

bool isCoplanar(const Mesh& mesh, const FaceCorners& a, const FaceCorners& b, double size) {
  const Vec3 normal = glm::normalize(scaledNormal(mesh, a));
  if (glm::dot(normal, scaledNormal(mesh, b)) <= 0) return false;
  return std::all_of(b.begin(), b.end(), [&](std::uint32_t corner) {
    return std::abs(glm::dot(normal, mesh.positions[corner] - mesh.positions[a[0]])) <= kFlat * size;
  });
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// For every triangle the number of its face. An edge that more than two triangles use joins none of them.
std::vector<std::size_t> facesOf(const Mesh& mesh, const std::vector<FaceCorners>& triangles, double size) {
  std::map<Edge, std::vector<std::size_t>> users;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
      users[{low, high}].push_back(t);
    }
  }
  std::vector<std::size_t> face(triangles.size());
  std::iota(face.begin(), face.end(), std::size_t{0});
  for (const auto& [edge, sharing] : users) {
    if (sharing.size() != 2) continue;
    const std::size_t a = face[sharing[0]], b = face[sharing[1]];
    // Against the face's first triangle, so that a gently curved strip does not creep into one plane.
    if (a != b && isCoplanar(mesh, triangles[a], triangles[sharing[1]], size) &&
        isCoplanar(mesh, triangles[b], triangles[sharing[0]], size)) {
      std::replace(face.begin(), face.end(), std::max(a, b), std::min(a, b));
    }
  }
  return face;
}

// The outline of the face's triangles, walked counter-clockwise from the front; nullopt unless it is one simple loop.
std::optional<std::vector<std::uint32_t>> outlineOf(const std::vector<FaceCorners>& triangles) {
  std::map<Edge, int> count;
  for (const FaceCorners& t : triangles) {
    for (int i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  }
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, times] : count) {
    if (times > 1) return std::nullopt;
    if (count.contains({edge.second, edge.first})) continue;
    if (!next.emplace(edge).second) return std::nullopt;
  }
  std::vector<std::uint32_t> outline;
  for (std::uint32_t at = next.begin()->first; outline.size() < next.size();) {
    outline.push_back(at);
    const auto following = next.find(at);
    if (following == next.end()) return std::nullopt;
    at = following->second;
    if (at == outline.front()) break;
  }
  if (outline.size() != next.size() || outline.size() < 3) return std::nullopt;
  return outline;
}

// Corners on a straight line between their neighbours say nothing.
std::vector<Vec3> cornersOf(const Mesh& mesh, const std::vector<std::uint32_t>& outline) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3& before = mesh.positions[outline[(i + outline.size() - 1) % outline.size()]];
    const Vec3& here = mesh.positions[outline[i]];
    const Vec3& after = mesh.positions[outline[(i + 1) % outline.size()]];
    const Vec3 in = here - before, out = after - here;
    const bool straight =
        glm::dot(in, out) > 0 && glm::length(glm::cross(in, out)) <= 1e-9 * glm::length(in) * glm::length(out);
    if (!straight) corners.push_back(here);
  }
  return corners;
}

std::optional<Polygon> polygonOf(const Mesh& mesh, const std::vector<FaceCorners>& triangles) {
  const auto outline = outlineOf(triangles);
  if (!outline) return std::nullopt;
  std::optional<Polygon> polygon = makePolygon(cornersOf(mesh, *outline));
  if (!polygon) return std::nullopt;
  double area = 0;
  Vec3 normal(0);
  for (const FaceCorners& t : triangles) {
    area += 0.5 * glm::length(scaledNormal(mesh, t));
    normal += scaledNormal(mesh, t);
  }
  // Triangles that overlap, or a triangulation that lost some of them, would change the surface.
  const bool same = std::abs(polygon->area - area) <= 1e-5 * area && glm::dot(normal, polygon->normal) > 0;
  return same ? polygon : std::nullopt;
}

double sizeOf(const Mesh& mesh) {
  Box box;
  for (const Vec3& position : mesh.positions) box.extend(position);
  return box.diagonal();
}

}  // namespace

std::vector<Shape> planarFaces(Mesh mesh) {
  const auto asMesh = [&] {
    std::vector<Shape> shapes;
    if (auto complete = makeMesh(std::move(mesh.positions), std::move(mesh.triangles), std::move(mesh.normals),
                                 std::move(mesh.texcoords))) {
      shapes.emplace_back(std::move(*complete));
    }
    return shapes;
  };
  if (mesh.triangles.size() > hierarchy::tuning::kInputs || !mesh.texcoords.empty() || !isFlatShaded(mesh))
    return asMesh();
  const std::vector<FaceCorners> triangles = weldedTriangles(mesh);
  const std::vector<std::size_t> face = facesOf(mesh, triangles, sizeOf(mesh));
  std::vector<Shape> shapes;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (face[first] != first) continue;
    std::vector<FaceCorners> members;
    for (std::size_t t = first; t < triangles.size(); ++t) {
      if (face[t] == first) members.push_back(triangles[t]);
    }
    std::optional<Polygon> polygon = polygonOf(mesh, members);
    if (!polygon) return asMesh();
    shapes.emplace_back(std::move(*polygon));
  }
  return shapes;
}

}  // namespace deltalux::io
