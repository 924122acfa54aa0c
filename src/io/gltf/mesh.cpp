#include "io/gltf/mesh.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <numeric>

#include "io/gltf/accessor.hpp"

namespace deltalux::io {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr const char* kHint = "export the scene again";
constexpr double kLargest = 1e15;  // coordinate [limit]

std::vector<Vec3> readPoints(const GltfDocument& document, int accessor) {
  const std::vector<double> values = readVectors(document, accessor, 3);
  std::vector<Vec3> points(values.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return points;
}

// [glTF 2.0, 3.7.2.1] Strips turn every other triangle round, fans share their first vertex.
std::vector<Triangle> trianglesOf(const std::vector<std::uint32_t>& indices, int mode) {
  std::vector<Triangle> triangles;
  if (indices.size() < 3) return triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
      triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
  } else {
    for (std::size_t i = 1; i + 1 < indices.size(); ++i) triangles.push_back({indices[i], indices[i + 1], indices[0]});
  }
  return triangles;
}

std::vector<std::uint32_t> indicesOf(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                     std::size_t vertexCount, const std::string& where) {
  if (primitive.indices < 0) {
    std::vector<std::uint32_t> all(vertexCount);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  std::vector<std::uint32_t> indices = readIndices(document, primitive.indices);
  for (const std::uint32_t index : indices) {
    if (index < vertexCount) continue;
    throw InputError(document.name, 0,
                     where + " refers to vertex " + std::to_string(index) + " of " + std::to_string(vertexCount),
                     kHint);
  }
  return indices;
}

// An attribute with one element per vertex, or -1.
int attributeOf(const GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& attribute,
                std::size_t vertexCount, const std::string& where) {
  const auto found = primitive.attributes.find(attribute);
  if (found == primitive.attributes.end()) return -1;
  const std::size_t count = document.model.accessors[static_cast<std::size_t>(found->second)].count;
  if (count != vertexCount) {
    throw InputError(
        document.name, 0,
        where + " has " + std::to_string(vertexCount) + " vertices, but " + std::to_string(count) + " of " + attribute,
        kHint);
  }
  return found->second;
}

void readTexcoords(const GltfDocument& document, int accessor, const TextureUse& texture, Mesh& mesh,
                   std::map<std::string, std::size_t>& ignored) {
  const std::vector<double> values = readVectors(document, accessor, 2);
  bool leavesImage = false;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
    const Vec2 texcoord = texture.transform * glm::dvec3(values[i], values[i + 1], 1);
    const bool usable = std::abs(texcoord.x) < kLargest && std::abs(texcoord.y) < kLargest;
    mesh.texcoords.push_back(usable ? texcoord : Vec2(0));
    leavesImage |= glm::clamp(texcoord, 0.0, 1.0) != texcoord;
  }
  if (leavesImage && !texture.repeats) ++ignored["textures that do not repeat (repeated)"];
}

void readNormals(const GltfDocument& document, int accessor, Mesh& mesh, std::map<std::string, std::size_t>& ignored) {
  mesh.normals = readPoints(document, accessor);
  const auto usable = [](const Vec3& n) { return glm::dot(n, n) > 1e-12 && glm::dot(n, n) < 1e12; };
  if (std::all_of(mesh.normals.begin(), mesh.normals.end(), usable)) return;
  mesh.normals.clear();
  ++ignored["normals without direction"];
}

}  // namespace

std::optional<Mesh> readMesh(const GltfDocument& document, const tinygltf::Primitive& primitive,
                             const std::string& where, const std::optional<TextureUse>& texture,
                             std::map<std::string, std::size_t>& ignored) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    ++ignored["points or lines"];
    return std::nullopt;
  }
  if (!primitive.targets.empty()) ++ignored["morph targets"];
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) throw InputError(document.name, 0, where + " has no POSITION", kHint);

  Mesh mesh;
  mesh.positions = readPoints(document, position->second);
  const std::size_t vertexCount = mesh.positions.size();
  mesh.triangles = trianglesOf(indicesOf(document, primitive, vertexCount, where), primitive.mode);
  const int normals = attributeOf(document, primitive, "NORMAL", vertexCount, where);
  if (normals >= 0) readNormals(document, normals, mesh, ignored);
  if (texture) {
    const std::string set = "TEXCOORD_" + std::to_string(texture->texcoordSet);
    const int texcoords = attributeOf(document, primitive, set, vertexCount, where);
    if (texcoords >= 0) readTexcoords(document, texcoords, *texture, mesh, ignored);
    if (texcoords < 0) {
      mesh.texcoords.assign(vertexCount, Vec2(0));
      ++ignored["textures without coordinates"];
    }
  }
  return mesh;
}

Mesh placedMesh(const Mesh& mesh, const Mat4& toWorld, const std::string& file, const std::string& where,
                std::map<std::string, std::size_t>& ignored) {
  Mesh placed;
  placed.texcoords = mesh.texcoords;
  for (const Vec3& position : mesh.positions) {
    placed.positions.push_back(Vec3(toWorld * glm::dvec4(position, 1)));
    const Vec3 size = glm::abs(placed.positions.back());
    if (!(size.x <= kLargest && size.y <= kLargest && size.z <= kLargest)) {
      throw InputError(file, 0, where + " has coordinates beyond 1e15 metres", "check its node's transform");
    }
  }
  const glm::dmat3 linear(toWorld);
  const bool mirrors = glm::determinant(linear) < 0;
  for (Triangle t : mesh.triangles) {
    if (mirrors) std::swap(t[1], t[2]);
    const Vec3 &a = placed.positions[t[0]], &b = placed.positions[t[1]], &c = placed.positions[t[2]];
    const double area = glm::length(glm::cross(b - a, c - a)),
                 longest = std::max(glm::length(b - a), glm::length(c - a));
    if (area > 1e-12 * longest * longest && area > 1e-300) placed.triangles.push_back(t);
  }
  if (placed.triangles.size() < mesh.triangles.size()) {
    ignored["triangles without area"] += mesh.triangles.size() - placed.triangles.size();
  }
  if (placed.triangles.empty()) return placed;
  // The cofactor matrix: the inverse transpose up to its scale, and right where that does not exist.
  const glm::dmat3 toWorldNormal(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                 glm::cross(linear[0], linear[1]));
  for (const Vec3& normal : mesh.normals) {
    const Vec3 turned = (mirrors ? -1.0 : 1.0) * (toWorldNormal * normal);
    const double length = glm::length(turned);
    if (!(length > 1e-290) || !std::isfinite(length)) {
      placed.normals.clear();
      break;
    }
    placed.normals.push_back(turned / length);
  }
  return placed;
}

}  // namespace deltalux::io
