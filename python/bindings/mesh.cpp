// A solution's triangles as arrays: views of a snapshot, which they keep alive.
#include <deltalux/solution_mesh.hpp>
#include <memory>
#include <string>

#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bind.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

using Snapshot = std::shared_ptr<SolutionMesh>;

/// One side of a surface, of a snapshot.
struct Side {
  std::shared_ptr<const SurfaceMesh> mesh;
  std::string object;
};

template <class Member>
py::array ofVertices(const Side& side, Member member) {
  const std::vector<MeshVertex>& vertices = side.mesh->vertices;
  const float* first = vertices.empty() ? nullptr : &(vertices.front().*member).x;
  return viewOf(first, vertices.size(), (MeshVertex{}.*member).length(), sizeof(MeshVertex), side.mesh);
}

/// Indices, `width` in a row.
py::array ofIndices(const Side& side, const std::vector<std::uint32_t>& indices, std::size_t width) {
  return viewOf(indices.data(), indices.size() / width, width, width * sizeof(std::uint32_t), side.mesh);
}

py::tuple triple(const Rgb& c) { return py::make_tuple(c.r, c.g, c.b); }

std::vector<Side> sidesOf(const Snapshot& snapshot) {
  std::vector<Side> sides;
  const Scene& scene = *snapshot->scene;
  for (const std::shared_ptr<const SurfaceMesh>& side : snapshot->surfaces) {
    if (!side || side->vertices.empty()) continue;
    const ObjectId object = scene[side->primitive].object;
    sides.push_back({side, object.valid() ? scene[object].name : ""});
  }
  return sides;
}

/// The caustic textures of all sides: texels, positions, texture coordinates, triangles of each.
py::list causticsOf(const Snapshot& snapshot) {
  py::list all;
  for (const std::shared_ptr<const SurfaceCausticMesh>& side : snapshot->caustics) {
    if (!side) continue;
    for (const CausticMesh& t : side->textures) {
      const auto* texel = t.texels.empty() ? nullptr : &t.texels.front().x;
      const auto* corner = t.vertices.empty() ? nullptr : &t.vertices.front();
      const std::size_t stride = sizeof(CausticMesh::Vertex), texels = t.texels.size();
      const py::array flat = viewOf(texel, texels, 4, sizeof(glm::vec4), side);
      all.append(
          py::make_tuple(side->primitive.value, side->front, flat.attr("reshape")(t.height, t.width, 4),
                         viewOf(corner ? &corner->position.x : nullptr, t.vertices.size(), 3, stride, side),
                         viewOf(corner ? &corner->texcoord.x : nullptr, t.vertices.size(), 2, stride, side),
                         viewOf(t.triangles.data(), t.triangles.size() / 3, 3, 3 * sizeof(std::uint32_t), side)));
    }
  }
  return all;
}

}  // namespace

void bindMesh(py::module_& m) {
  py::class_<Side>(m, "SurfaceMesh",
                   "One side of a surface, in a snapshot of a solution. Arrays are read-only views of the snapshot; "
                   "positions are\nrelative to Mesh.origin.")
      .def_readonly("object", &Side::object, "Name of its object; '' of none.")
      .def_property_readonly(
          "surface", [](const Side& s) { return s.mesh->primitive.value; }, "Number of its surface in the scene.")
      .def_property_readonly(
          "front", [](const Side& s) { return s.mesh->front; }, "Whether it is the front.")
      .def_property_readonly(
          "shape_version", [](const Side& s) { return s.mesh->shapeVersion; },
          "Mesh.version of the snapshot in which positions or triangles last changed.")
      .def_property_readonly(
          "light_version", [](const Side& s) { return s.mesh->lightVersion; },
          "The same of irradiance, albedo or emission.")
      .def_property_readonly(
          "albedo", [](const Side& s) { return triple(s.mesh->albedo); }, "Diffuse reflectance.")
      .def_property_readonly(
          "transmittance", [](const Side& s) { return triple(s.mesh->transmittance); }, "Diffuse transmittance.")
      .def_property_readonly(
          "radiance", [](const Side& s) { return triple(s.mesh->radiance); },
          "What it emits along its normal [W/(sr m2)].")
      .def_property_readonly(
          "positions", [](const Side& s) { return ofVertices(s, &MeshVertex::position); }, "(V,3) float32.")
      .def_property_readonly(
          "normals", [](const Side& s) { return ofVertices(s, &MeshVertex::normal); }, "(V,3) float32, unit.")
      .def_property_readonly(
          "uv", [](const Side& s) { return ofVertices(s, &MeshVertex::uv); }, "(V,2) float32, of textures.")
      .def_property_readonly(
          "direct", [](const Side& s) { return ofVertices(s, &MeshVertex::direct); },
          "(V,3) float32 [W/m2]: irradiance straight from lights.")
      .def_property_readonly(
          "indirect", [](const Side& s) { return ofVertices(s, &MeshVertex::indirect); },
          "(V,3) float32 [W/m2]: irradiance by diffuse reflection.")
      .def_property_readonly(
          "particle", [](const Side& s) { return ofVertices(s, &MeshVertex::particle); },
          "(V,3) float32 [W/m2]: irradiance by mirrors, gloss and glass; 0 where caustic textures show it.")
      .def_property_readonly(
          "triangles", [](const Side& s) { return ofIndices(s, s.mesh->triangles, 3); },
          "(T,3) uint32, counter-clockwise seen from this side.")
      .def_property_readonly(
          "outlines", [](const Side& s) { return ofIndices(s, s.mesh->outlines, 2); },
          "(L,2) uint32: borders of the patches that light was solved for.");
  py::class_<SolutionMesh, std::shared_ptr<SolutionMesh>>(m, "MeshSnapshot")
      .def_readonly("version", &SolutionMesh::version)
      .def_property_readonly("origin",
                             [](const SolutionMesh& mesh) {
                               const Vec3& o = mesh.scene->origin;
                               return arrayOf<double>(std::vector<double>{o.x, o.y, o.z}, {3});
                             })
      .def_property_readonly("up",
                             [](const SolutionMesh& mesh) {
                               const Vec3& up = mesh.scene->up;
                               return arrayOf<double>(std::vector<double>{up.x, up.y, up.z}, {3});
                             })
      .def_property_readonly("objects",
                             [](const SolutionMesh& mesh) {
                               std::vector<std::string> names;
                               for (const Object& object : mesh.scene->objects) names.push_back(object.name);
                               return names;
                             })
      .def_property_readonly("surfaces", [](const std::shared_ptr<SolutionMesh>& mesh) { return sidesOf(mesh); })
      .def_property_readonly("caustics", [](const std::shared_ptr<SolutionMesh>& mesh) { return causticsOf(mesh); });
}

}  // namespace deltalux::python
