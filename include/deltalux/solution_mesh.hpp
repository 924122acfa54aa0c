#pragma once
// A solution as triangles with light on them: what a viewer, an exporter or a script takes over. A SolutionMesh is a
// snapshot: later steps of the engine do not change it, and copies share what they have in common. Snapshots of one
// SolutionReader are numbered, and every part says in which snapshot it last changed, so that only that need be taken
// over again.
//
// Irradiance at a point is direct + indirect + particle of the mesh, interpolated, plus what the caustic textures of
// its side show there: light is in one of them and never in two. The mesh has no T-vertices: surfaces that meet along
// an edge of one plane share the points of it.
#include <cstdint>
#include <deltalux/scene.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace deltalux {

struct MeshVertex {
  Vec3f position{0.0f};  // scene units, relative to Scene::origin
  Vec3f normal{0.0f};    // unit, out of the side that it is of; smooth over curved shapes
  glm::vec2 uv{0.0f};    // texture coordinates of meshes (0: it has none); parameters of other shapes (shape.hpp)
  Rgb direct{0.0f}, indirect{0.0f}, particle{0.0f};  // E [W/m2]; particle is 0 where caustic textures show it
};

/// One side of a primitive.
struct SurfaceMesh {
  PrimitiveId primitive;
  bool front = true;
  std::uint64_t shapeVersion = 0;  // of the snapshot in which positions or triangles last changed
  std::uint64_t lightVersion = 0;  // the same of irradiance, albedo or emission
  Rgb albedo{0.0f};                // rho of this side, diffuse; a texture of the material multiplies it
  Rgb transmittance{0.0f};         // tau, diffuse: multiplies the irradiance of the other side
  Rgb radiance{0.0f};              // L that it emits along its normal [W/(sr m2)]
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> triangles;  // three indices each, counter-clockwise seen from this side
  std::vector<std::uint32_t> outlines;   // two indices a line: the borders of the patches that light was solved for
};

/// One caustic texture, and the triangles that show it.
struct CausticMesh {
  struct Vertex {
    Vec3f position{0.0f};
    glm::vec2 texcoord{0.0f};  // [0,1] over the texture, its first row at 0; texel centres at (i + 0.5) / size
  };
  int width = 0, height = 0;
  std::vector<glm::vec4> texels;  // E [W/m2] and 1; 0 in the fourth where another texture shows the point, or none:
                                  // nothing is shown there, and E is what to interpolate with
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;
};

/// The caustic textures of one side of a primitive: at every point at most one of them shows.
struct SurfaceCausticMesh {
  PrimitiveId primitive;
  bool front = true;
  std::uint64_t version = 0;  // of the snapshot in which any of it last changed
  std::vector<CausticMesh> textures;
};

struct SolutionMesh {
  std::uint64_t version = 0;  // 0: nothing yet
  std::shared_ptr<const Scene> scene;
  /// By 2 * primitive + (front ? 0 : 1); null where a side has no extent. One that was there and is gone is empty.
  std::vector<std::shared_ptr<const SurfaceMesh>> surfaces;
  /// The same order; null, or without textures: the mesh shows all light.
  std::vector<std::shared_ptr<const SurfaceCausticMesh>> caustics;

  static std::size_t side(PrimitiveId p, bool front) { return 2 * p.index() + (front ? 0 : 1); }
};

/// Sides of `now` that are not as they were in the snapshot numbered `version` of the same reader, ascending; those
/// that are gone, too. 0: all.
struct MeshChange {
  std::vector<std::size_t> shapes, lights, caustics;
};
MeshChange changedSince(const SolutionMesh& now, std::uint64_t version);

/// Checks every index, normal and number; throws std::logic_error with the first that does not hold.
void validate(const SolutionMesh&);

}  // namespace deltalux
