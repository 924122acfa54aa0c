#include "io/gltf/vertex_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deltalux/error.hpp>
#include <map>

#include "io/gltf/accessor.hpp"

namespace deltalux::io {

namespace {

constexpr std::size_t kMostColours = 32;                   // that part a mesh [limit]
constexpr std::size_t kMostTexturedTriangles = 1'000'000;  // [limit]
constexpr float kMostColour = 1e3f;                        // of a factor [limit]

Rgb meanOf(const Mesh& mesh, const std::vector<Rgb>& colours) {
  Rgb sum(0.0f);
  float weight = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const auto area = static_cast<float>(glm::length(glm::cross(b - a, c - a)));
    sum += area / 3 * (colours[t[0]] + colours[t[1]] + colours[t[2]]), weight += area;
  }
  return weight > 0 ? sum / weight : Rgb(1.0f);
}

using ColourKey = std::array<float, 3>;
ColourKey keyOf(const Rgb& c) { return {c.r, c.g, c.b}; }

/// Triangles by their colour; nothing where one has several, or there are too many of them.
std::optional<std::map<ColourKey, std::vector<std::size_t>>> byColour(const Mesh& mesh,
                                                                      const std::vector<Rgb>& colours) {
  std::map<ColourKey, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (colours[t[0]] != colours[t[1]] || colours[t[0]] != colours[t[2]]) return std::nullopt;
    groups[keyOf(colours[t[0]])].push_back(i);
    if (groups.size() > kMostColours) return std::nullopt;
  }
  return groups;
}

Mesh partOf(const Mesh& mesh, const std::vector<std::size_t>& triangles) {
  Mesh part;
  std::map<std::uint32_t, std::uint32_t> places;
  for (const std::size_t i : triangles) {
    auto corners = mesh.triangles[i];
    for (std::uint32_t& corner : corners) {
      const auto [place, isNew] = places.try_emplace(corner, static_cast<std::uint32_t>(part.positions.size()));
      if (isNew) {
        part.positions.push_back(mesh.positions[corner]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[corner]);
        if (!mesh.texcoords.empty()) part.texcoords.push_back(mesh.texcoords[corner]);
      }
      corner = place->second;
    }
    part.triangles.push_back(corners);
  }
  return part;
}

/// The corners' colours stand at the centres of three texels of a triangle's square. The fourth goes on as they do,
/// below 0 where they do: it is beyond the triangle.
ColouredMesh texturedByColour(const Mesh& mesh, const std::vector<Rgb>& colours) {
  ColouredMesh result;
  result.mean = meanOf(mesh, colours);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(mesh.triangles.size()))));
  Texture& texture = result.texture.emplace();
  texture.name = "COLOR_0";
  texture.width = texture.height = static_cast<int>(2 * side);
  texture.texels.assign(4 * side * side, result.mean);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::size_t column = 2 * (i % side), row = 2 * (i / side);
    const auto& t = mesh.triangles[i];
    const Rgb &a = colours[t[0]], &b = colours[t[1]], &c = colours[t[2]];
    const auto texel = [&](std::size_t x, std::size_t y) -> Rgb& {
      return texture.texels[(row + y) * 2 * side + column + x];
    };
    texel(0, 0) = a, texel(1, 0) = b, texel(0, 1) = c, texel(1, 1) = b + c - a;
    const std::array<Vec2, 3> at{Vec2(0.5, 0.5), Vec2(1.5, 0.5), Vec2(0.5, 1.5)};
    const auto first = static_cast<std::uint32_t>(result.mesh.positions.size());
    for (std::size_t k = 0; k < 3; ++k) {
      result.mesh.positions.push_back(mesh.positions[t[k]]);
      if (!mesh.normals.empty()) result.mesh.normals.push_back(mesh.normals[t[k]]);
      result.mesh.texcoords.push_back((Vec2(column, row) + at[k]) / static_cast<double>(2 * side));
    }
    result.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

}  // namespace

std::vector<Rgb> readVertexColours(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                   std::size_t vertexCount, const std::string& where) {
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end()) return {};
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(found->second)];
  if (accessor.count != vertexCount)
    throw InputError(document.name, 0,
                     where + " has " + std::to_string(vertexCount) + " vertices, but " +
                         std::to_string(accessor.count) + " of COLOR_0",
                     "export the scene again");
  const std::size_t width = accessor.type == TINYGLTF_TYPE_VEC4 ? 4 : 3;
  const std::vector<double> values = readVectors(document, found->second, static_cast<int>(width));
  std::vector<Rgb> colours(vertexCount);
  for (std::size_t i = 0; i < vertexCount; ++i)
    for (int c = 0; c < 3; ++c)
      colours[i][c] =
          std::clamp(static_cast<float>(values[width * i + static_cast<std::size_t>(c)]), 0.0f, kMostColour);
  return colours;
}

std::vector<ColouredMesh> colouredMeshes(Mesh mesh, const std::vector<Rgb>& colours, bool byMean) {
  if (byMean || mesh.triangles.empty()) {
    const Rgb mean = meanOf(mesh, colours);
    return {{std::move(mesh), mean, std::nullopt}};
  }
  std::vector<ColouredMesh> parts;
  if (const auto groups = byColour(mesh, colours)) {
    for (const auto& [colour, triangles] : *groups)
      parts.push_back({partOf(mesh, triangles), Rgb(colour[0], colour[1], colour[2]), std::nullopt});
    return parts;
  }
  if (mesh.triangles.size() > kMostTexturedTriangles) return colouredMeshes(std::move(mesh), colours, true);
  parts.push_back(texturedByColour(mesh, colours));
  return parts;
}

}  // namespace deltalux::io
