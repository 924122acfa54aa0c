#include "io/ply.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/gunzip.hpp"
#include "io/ply/values.hpp"
#include "io/triangulated.hpp"

namespace deltalux::io {

namespace ply {

namespace {

constexpr double kLargest = 1e15;           // coordinate [limit]
constexpr std::size_t kMostCorners = 1000;  // of a face [limit]
constexpr std::size_t kSlots = 8;           // of what is read of a vertex: x y z, nx ny nz, u v [layout]

/// Where a property of a vertex goes; kSlots for one that is passed over.
std::size_t slotOf(const Property& property) {
  if (property.count) return kSlots;
  static const std::map<std::string_view, std::size_t> kNames{
      {"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3},        {"ny", 4},        {"nz", 5},        {"u", 6},
      {"v", 7}, {"s", 6}, {"t", 7}, {"texture_u", 6}, {"texture_v", 7}, {"texture_s", 6}, {"texture_t", 7}};
  const auto found = kNames.find(property.name);
  return found == kNames.end() ? kSlots : found->second;
}

void readVertices(Values& values, const Element& element, Mesh& mesh) {
  std::vector<std::size_t> slots;
  std::array<bool, kSlots + 1> has{};
  for (const Property& property : element.properties) slots.push_back(slotOf(property)), has[slots.back()] = true;
  if (!has[0] || !has[1] || !has[2]) values.fail(element, "the vertices have no x, y, z");
  bool shaded = has[3] && has[4] && has[5], textured = has[6] && has[7];
  const std::size_t expected = std::min<std::size_t>(element.count, values.atMost());
  mesh.positions.reserve(expected);
  if (shaded) mesh.normals.reserve(expected);
  if (textured) mesh.texcoords.reserve(expected);
  std::array<double, kSlots + 1> at{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (element.properties[p].count)
        values.skip(element.properties[p]);
      else
        at[slots[p]] = values.next(element.properties[p].number);
    }
    if (!(std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])}) <= kLargest) || std::isnan(at[1] + at[2]))
      values.fail("vertex " + std::to_string(i) + " lies beyond all bounds");
    mesh.positions.push_back({at[0], at[1], at[2]});
    const Vec3 normal(at[3], at[4], at[5]);
    const double length = glm::length(normal);
    shaded = shaded && length > 1e-100 && length < 1e100;
    textured = textured && std::abs(at[6]) <= kLargest && std::abs(at[7]) <= kLargest;
    if (shaded) mesh.normals.push_back(normal / length);
    if (textured) mesh.texcoords.push_back({at[6], at[7]});
  }
  if (!shaded) mesh.normals.clear();
  if (!textured) mesh.texcoords.clear();
}

/// The corners of all faces, one after the other, each face behind how many it has.
std::vector<std::uint32_t> readFaces(Values& values, const Element& element,
                                     std::map<std::string, std::size_t>& ignored) {
  const auto isIndices = [](const Property& p) {
    return p.count && p.number < Number::Float32 && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (std::ranges::none_of(element.properties, isIndices) && element.count > 0)
    values.fail(element, "the faces have no list vertex_indices");
  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const Property& property : element.properties) {
      if (!isIndices(property)) {
        values.skip(property);
        continue;
      }
      const std::size_t count = values.nextCount(*property.count);
      if (count > kMostCorners) values.fail("face " + std::to_string(i) + " has too many corners");
      if (count < 3) {
        ++ignored["faces of fewer than 3 corners"];
        for (std::size_t c = 0; c < count; ++c) values.nextCount(property.number);
        continue;
      }
      corners.push_back(static_cast<std::uint32_t>(count));
      for (std::size_t c = 0; c < count; ++c)
        corners.push_back(static_cast<std::uint32_t>(values.nextCount(property.number)));
    }
  return corners;
}

void addFaces(const std::vector<std::uint32_t>& corners, const Values& values, Mesh& mesh,
              std::map<std::string, std::size_t>& ignored) {
  std::vector<Vec3> outline;
  for (std::size_t at = 0; at < corners.size();) {
    const std::size_t count = corners[at++];
    outline.clear();
    for (std::size_t c = 0; c < count; ++c) {
      if (corners[at + c] >= mesh.positions.size())
        values.fail("a face refers to vertex " + std::to_string(corners[at + c]) + " of " +
                    std::to_string(mesh.positions.size()));
      outline.push_back(mesh.positions[corners[at + c]]);
    }
    const std::size_t before = mesh.triangles.size();
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (hasArea(outline[a], outline[b], outline[c]))
        mesh.triangles.push_back({corners[at + a], corners[at + b], corners[at + c]});
    };
    if (count == 3)
      add(0, 1, 2);
    else
      for (const auto& [a, b, c] : triangulated(outline)) add(a, b, c);
    if (mesh.triangles.size() == before) ++ignored["faces without area"];
    at += count;
  }
}

}  // namespace

}  // namespace ply

Mesh readPly(std::string_view bytes, const std::string& file, std::map<std::string, std::size_t>& ignored) {
  std::string unpacked;
  using namespace ply;
  if (isGzip(bytes)) bytes = unpacked = gunzip(bytes, file);
  const Header header = readHeader(bytes, file);
  Values values(bytes, header, file);
  Mesh mesh;
  std::vector<std::uint32_t> corners;
  bool vertices = false, faces = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex" && !std::exchange(vertices, true)) {
      readVertices(values, element, mesh);
    } else if (element.name == "face" && !std::exchange(faces, true)) {
      corners = readFaces(values, element, ignored);
    } else if (!element.properties.empty()) {
      if (element.count > 0) ++ignored["PLY's element " + element.name.substr(0, 40)];
      for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) values.skip(property);
    }
  }
  if (!vertices || !faces) values.fail("has no vertices or no faces");
  addFaces(corners, values, mesh, ignored);
  return mesh;
}

}  // namespace deltalux::io
