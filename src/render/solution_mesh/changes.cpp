// What of a snapshot has changed since, and whether it is sound.
#include <algorithm>
#include <deltalux/solution_mesh.hpp>
#include <stdexcept>
#include <string>

namespace deltalux {

MeshChange changedSince(const SolutionMesh& now, std::uint64_t version) {
  MeshChange change;
  for (std::size_t i = 0; i < now.surfaces.size(); ++i) {
    if (!now.surfaces[i]) continue;
    if (now.surfaces[i]->shapeVersion > version) change.shapes.push_back(i);
    if (now.surfaces[i]->lightVersion > version) change.lights.push_back(i);
  }
  for (std::size_t i = 0; i < now.caustics.size(); ++i)
    if (now.caustics[i] && now.caustics[i]->version > version) change.caustics.push_back(i);
  return change;
}

namespace {

constexpr float kUnit = 1e-3f;        // that a normal's length may be off by [rounding]
constexpr float kBeyondEdge = 1e-4f;  // of texture coordinates, by rounding [rounding]

[[noreturn]] void failAt(std::size_t side, const char* what) {
  throw std::logic_error("solution mesh: side " + std::to_string(side) + ": " + what);
}

template <class Vector>
bool isFinite(const Vector& v) {
  for (int i = 0; i < Vector::length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

template <class Vector>
bool isLight(const Vector& v) {
  for (int i = 0; i < Vector::length(); ++i)
    if (!(v[i] >= 0)) return false;
  return isFinite(v);
}

void checkIndices(const std::vector<std::uint32_t>& indices, std::size_t each, std::size_t vertices, std::size_t side) {
  if (indices.size() % each != 0) failAt(side, "half a triangle or line");
  for (const std::uint32_t i : indices)
    if (i >= vertices) failAt(side, "an index beyond its vertices");
}

void checkSurface(const SurfaceMesh& s, std::size_t side, std::uint64_t version) {
  if (SolutionMesh::side(s.primitive, s.front) != side) failAt(side, "is another side's");
  if (s.shapeVersion > version || s.lightVersion > version) failAt(side, "a version to come");
  checkIndices(s.triangles, 3, s.vertices.size(), side);
  checkIndices(s.outlines, 2, s.vertices.size(), side);
  if (!isLight(s.albedo) || !isLight(s.transmittance) || !isLight(s.radiance))
    failAt(side, "no reflectance or radiance");
  for (const MeshVertex& v : s.vertices) {
    if (!isFinite(v.position) || !isFinite(v.uv)) failAt(side, "a vertex that is nowhere");
    if (!(std::abs(glm::length(v.normal) - 1) < kUnit)) failAt(side, "a normal that is not of unit length");
    if (!isLight(v.direct) || !isLight(v.indirect) || !isLight(v.particle)) failAt(side, "no irradiance");
  }
}

void checkCaustics(const SurfaceCausticMesh& s, std::size_t side, std::uint64_t version) {
  if (SolutionMesh::side(s.primitive, s.front) != side) failAt(side, "is another side's");
  if (s.version > version) failAt(side, "a version to come");
  for (const CausticMesh& t : s.textures) {
    if (t.width < 1 || t.height < 1 ||
        t.texels.size() != static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
      failAt(side, "a texture of another size than it says");
    checkIndices(t.triangles, 3, t.vertices.size(), side);
    for (const glm::vec4& E : t.texels)
      if (!isLight(E) || (E.w != 0 && E.w != 1)) failAt(side, "no irradiance in a texture");
    for (const CausticMesh::Vertex& v : t.vertices)
      if (!isFinite(v.position) || !(v.texcoord.x >= -kBeyondEdge && v.texcoord.x <= 1 + kBeyondEdge) ||
          !(v.texcoord.y >= -kBeyondEdge && v.texcoord.y <= 1 + kBeyondEdge))
        failAt(side, "a texture coordinate beyond its texture");
  }
}

}  // namespace

void validate(const SolutionMesh& mesh) {
  if (mesh.version == 0 && !mesh.scene && mesh.surfaces.empty() && mesh.caustics.empty()) return;
  if (!mesh.scene) throw std::logic_error("solution mesh: no scene");
  const std::size_t sides = 2 * mesh.scene->primitives.size();
  if (mesh.surfaces.size() != sides || mesh.caustics.size() != sides)
    throw std::logic_error("solution mesh: not as many sides as its scene has");
  for (std::size_t i = 0; i < sides; ++i) {
    if (mesh.surfaces[i]) checkSurface(*mesh.surfaces[i], i, mesh.version);
    if (mesh.caustics[i]) checkCaustics(*mesh.caustics[i], i, mesh.version);
  }
}

}  // namespace deltalux
