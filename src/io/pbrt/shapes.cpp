#include "io/pbrt/shapes.hpp"

#include <algorithm>

#include "io/import_file.hpp"
#include "io/planar_faces.hpp"
#include "io/ply.hpp"
#include "io/triangulated.hpp"

namespace deltalux::io::pbrt {

namespace {

/// Normals at vertices say what is in front, whatever the order of corners.
void turnToNormals(Mesh& mesh) {
  if (mesh.normals.empty()) return;
  for (auto& [a, b, c] : mesh.triangles) {
    const Vec3 &at = mesh.positions[a], normal = mesh.normals[a] + mesh.normals[b] + mesh.normals[c];
    if (glm::dot(glm::cross(mesh.positions[b] - at, mesh.positions[c] - at), normal) < 0) std::swap(b, c);
  }
}

std::vector<Shape> shapesOfMesh(Mesh mesh) {
  mesh.texcoords.clear();
  if (mesh.triangles.empty()) return {};
  turnToNormals(mesh);
  return planarFaces(std::move(mesh));
}

/// What P and N say of the vertices.
Mesh verticesOf(const Entity& e) {
  Mesh mesh;
  mesh.positions = pointsOf(e, "P");
  if (mesh.positions.empty()) fail(e.at, "the shape has no vertices P");
  mesh.normals = pointsOf(e, "N");
  const auto isUsable = [](const Vec3& n) { return glm::length(n) > 1e-100; };
  if (mesh.normals.size() != mesh.positions.size() || !std::ranges::all_of(mesh.normals, isUsable))
    mesh.normals.clear();
  for (Vec3& n : mesh.normals) n = glm::normalize(n);
  return mesh;
}

/// So many together; those of the only face there is, where they need not be said.
std::vector<std::uint32_t> indicesOf(const Entity& e, std::size_t together, const Mesh& vertices) {
  std::vector<std::uint32_t> indices;
  if (const std::vector<double> given = numbersOf(e, "indices", together); !given.empty()) {
    for (const double index : given) {
      if (!(index >= 0 && index < static_cast<double>(vertices.positions.size())))
        fail(find(e, "indices")->at, "the shape refers to a vertex that is not there");
      indices.push_back(static_cast<std::uint32_t>(index));
    }
  } else {
    if (vertices.positions.size() != together) fail(e.at, "the shape has no indices");
    for (std::uint32_t i = 0; i < together; ++i) indices.push_back(i);
  }
  return indices;
}

std::vector<Shape> triangleMesh(Context& context, const Entity& e) {
  Mesh mesh = verticesOf(e);
  const std::vector<std::uint32_t> indices = indicesOf(e, 3, mesh);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{indices[i], indices[i + 1], indices[i + 2]};
    if (hasArea(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]))
      mesh.triangles.push_back(t);
    else
      ignore(context, "faces without area");
  }
  return shapesOfMesh(std::move(mesh));
}

std::vector<Shape> bilinearMesh(Context& context, const Entity& e) {
  Mesh mesh = verticesOf(e);
  const std::vector<std::uint32_t> indices = indicesOf(e, 4, mesh);
  for (std::size_t i = 0; i < indices.size(); i += 4) {
    // Corners (0,0), (1,0), (0,1), (1,1) as they lie around the patch.
    const std::uint32_t around[] = {indices[i], indices[i + 1], indices[i + 3], indices[i + 2]};
    std::vector<Vec3> outline;
    for (const std::uint32_t corner : around) outline.push_back(mesh.positions[corner]);
    bool any = false;
    for (const auto& [a, b, c] : triangulated(outline)) {
      if (!hasArea(outline[a], outline[b], outline[c])) continue;
      mesh.triangles.push_back({around[a], around[b], around[c]});
      any = true;
    }
    if (!any)
      ignore(context, "faces without area");
    else if (!makePolygon(outline))
      ignore(context, "bends of bilinear patches (two triangles each)");
  }
  return shapesOfMesh(std::move(mesh));
}

std::vector<Shape> plyMesh(Context& context, const Entity& e) {
  const Parameter* name = find(e, "filename");
  if (!name) fail(e.at, "the shape names no file");
  if (find(e, "displacement")) ignore(context, "displacement");
  const std::filesystem::path path = fileOf(context, *name);
  return shapesOfMesh(readPly(readInputFile(path), path.string(), context.report.ignored));
}

/// Whether a round shape is not there all the way round.
bool isSector(const Entity& e) { return numberOr(e, "phimax", 360) < 360; }

double radiusOf(const Entity& e) {
  const double radius = numberOr(e, "radius", 1);
  if (!(radius > 1e-12)) fail(e.at, "its radius is not above 0");
  return radius;
}

std::vector<Shape> partial(Context& context, const Entity& e) {
  ignore(context, "shape " + e.type + " (partial)");
  return {};
}

std::vector<Shape> sphere(Context& context, const Entity& e) {
  const double radius = radiusOf(e);
  if (isSector(e) || numberOr(e, "zmin", -radius) > -radius || numberOr(e, "zmax", radius) < radius)
    return partial(context, e);
  return {Sphere{Vec3(0), radius, false}};
}

std::vector<Shape> cylinder(Context& context, const Entity& e) {
  const double radius = radiusOf(e), z0 = numberOr(e, "zmin", -1), z1 = numberOr(e, "zmax", 1);
  if (!(std::abs(z1 - z0) > 1e-12)) fail(e.at, "its ends are one point");
  if (isSector(e)) return partial(context, e);
  return {Cylinder{{0, 0, std::min(z0, z1)}, {0, 0, std::max(z0, z1)}, radius, false}};
}

std::vector<Shape> disk(Context& context, const Entity& e) {
  const double radius = radiusOf(e), inner = numberOr(e, "innerradius", 0);
  if (!(inner >= 0 && inner < radius)) fail(e.at, "its inner radius is not within its radius");
  if (isSector(e)) return partial(context, e);
  return {Ring{{0, 0, numberOr(e, "height", 0)}, {0, 0, 1}, inner, radius}};
}

}  // namespace

std::vector<Shape> shapesOf(Context& context, const Entity& e) {
  if (e.type == "trianglemesh") return triangleMesh(context, e);
  if (e.type == "plymesh") return plyMesh(context, e);
  if (e.type == "bilinearmesh") return bilinearMesh(context, e);
  if (e.type == "sphere") return sphere(context, e);
  if (e.type == "cylinder") return cylinder(context, e);
  if (e.type == "disk") return disk(context, e);
  ignore(context, "shape " + e.type.substr(0, 40));
  return {};
}

}  // namespace deltalux::io::pbrt
