#pragma once
// The surfaces of a solution as one array of vertices and one of triangles, and what is drawn of them how.
//
// Vertices of a side (SolutionMesh::side) are neighbours, and sides follow in their order. Triangles are those of one
// draw after those of another.
#include <array>
#include <deltalux/light_groups.hpp>
#include <deltalux/solution_mesh.hpp>
#include <optional>
#include <vector>

namespace deltalux::exporting {

/// What a side does with light; fractions of incident flux.
struct PageMaterial {
  Rgb reflectance{0.0f};      // diffuse
  Rgb transmittance{0.0f};    // diffuse
  Rgb gloss{0.0f};            // what mirrors and lobes reflect
  std::uint32_t emitter = 0;  // sides that emit alike share a number

  bool operator==(const PageMaterial&) const = default;
};

/// Radiance of a material [W/(sr m2)] by a group's lights at scale 1; no group: whatever lights there are.
struct PageEmission {
  std::uint32_t material = 0;
  std::optional<std::size_t> group;
  Rgb radiance{0.0f};
};

/// A pane: light goes straight on through it. Index 1: the same at every angle.
struct PagePane {
  Rgb transmissivity{1.0f};
  float index = 1;

  bool operator==(const PagePane&) const = default;
};

/// A flat mirror.
struct PageMirror {
  glm::dvec4 plane{0};  // unit normal n and d: n . p = d
  std::vector<Vec3> corners;
};

struct PageDraw {
  enum class Kind { Opaque, Mirror, Behind, Pane };  // behind: seen from the other side, light that passes diffusely
  Kind kind = Kind::Opaque;
  TextureId texture;  // of the diffuse reflectance, where valid
  std::optional<PagePane> pane;
  std::optional<PageMirror> mirror;
  std::uint32_t first = 0, count = 0;  // in PageMesh::triangles
};

struct PageMesh {
  struct Side {
    std::uint32_t side = 0;  // of SolutionMesh
    std::uint32_t first = 0, count = 0, material = 0;
  };
  std::vector<Side> sides;
  std::vector<MeshVertex> vertices;  // without light
  std::vector<std::vector<std::uint32_t>>
      source;                            // by group and vertex: the side's in the group's mesh; until simplify()
  std::vector<std::uint32_t> triangles;  // three indices each
  std::vector<PageDraw> draws;
  std::vector<PageMaterial> materials;
  std::vector<PageEmission> emission;
};

/// `meshes`: by group of lights, those of lightOf(). Their triangles are the same; which of them share a vertex may
/// differ, as light decides whether patches that something stands on do: in the page's mesh those share one that do so
/// for every group. Throws InputError where they are not of one shape.
PageMesh pageMesh(const std::vector<LightGroup>&, const std::vector<SolutionMesh>& meshes);

using SideTriangles = std::vector<std::array<std::uint32_t, 3>>;
/// By side, its triangles, in the mesh's numbers of vertices. (A side that is drawn from behind, too, has them once.)
std::vector<SideTriangles> trianglesOfSides(const PageMesh&);
/// By vertex: its side.
std::vector<std::uint32_t> sideOfVertices(const PageMesh&);

/// Puts other triangles in the place of a mesh's. `of`: by side, in numbers of its vertices from 0; `firsts`: by side,
/// what is added to those. Vertices and sides stay as they are.
void replaceTriangles(PageMesh&, const std::vector<SideTriangles>& of, const std::vector<std::uint32_t>& firsts);

/// Irradiance by vertex of the page's mesh as it was built, of a group and its mesh: all of it, and what is direct
/// [W/m2].
std::vector<Rgb> pageLayer(const PageMesh&, std::size_t group, const SolutionMesh&);
std::vector<Rgb> pageDirect(const PageMesh&, std::size_t group, const SolutionMesh&);

}  // namespace deltalux::exporting
