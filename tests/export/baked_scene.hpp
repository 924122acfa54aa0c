#pragma once
// Small solved scenes with their atlas, and how a texture unit reads a page.
#include <deltalux/engine.hpp>
#include <deltalux/export_glb.hpp>
#include <deltalux/solution_reader.hpp>

#include "export/lightmap.hpp"
#include "support/rooms.hpp"
#include "support/solution_scenes.hpp"
#include "support/solved.hpp"

namespace deltalux::test {

inline const double kCrease = glm::radians(GlbSettings{}.crease);

struct BakedScene {
  SolutionMesh mesh;
  exporting::Atlas atlas;
  std::vector<Image> pages;
};

/// As the mesh has it.
inline exporting::MeasuredLight unmeasured(const SolutionMesh& mesh) {
  return {mesh, std::vector<std::shared_ptr<const exporting::SideDirect>>(mesh.surfaces.size())};
}

inline BakedScene baked(SolutionMesh mesh, const exporting::AtlasSettings& settings) {
  BakedScene scene;
  scene.mesh = std::move(mesh);
  std::vector<exporting::AtlasChart> charts = exporting::litCharts(scene.mesh, kCrease);
  const double finest = exporting::finestTexel(scene.mesh, charts);
  scene.atlas = layOut(std::move(charts), settings, finest);
  scene.pages = bake(scene.atlas, scene.mesh, unmeasured(scene.mesh),
                     [](const exporting::BakedTexel& t) { return t.irradiance; });
  return scene;
}

inline SolutionMesh meshOf(const Engine& engine) { return SolutionReader(engine.solution()).mesh(); }

inline Engine everythingSolved() {
  Engine engine(oneOfEverything(), coarse());
  engine.solve();
  return engine;
}

/// Bilinear, its edges held.
inline Rgb readPage(const Image& page, const Vec2& texcoord) {
  const Vec2 at = texcoord * Vec2(page.width, page.height) - 0.5, corner = glm::floor(at), f = at - corner;
  const auto texel = [&](int dx, int dy) {
    return glm::dvec3(page.at(std::clamp(static_cast<int>(corner.x) + dx, 0, page.width - 1),
                              std::clamp(static_cast<int>(corner.y) + dy, 0, page.height - 1)));
  };
  return Rgb(glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y));
}

/// A side with one vertex per corner of a grid of squares over (0,0) to (size,size) in the plane z = 0; E by position.
template <class Light>
SurfaceMesh gridSide(int cells, double size, const Light& E) {
  SurfaceMesh side;
  side.primitive = PrimitiveId(0);
  const auto add = [&](double x, double y) {
    MeshVertex v;
    v.position = Vec3f(Vec3(x, y, 0)), v.normal = Vec3f(0, 0, 1), v.direct = E(x, y);
    side.vertices.push_back(v);
  };
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) add(size * x / cells, size * y / cells);
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t y = 0; y + 1 < row; ++y)
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t i = y * row + x;
      side.triangles.insert(side.triangles.end(), {i, i + 1, i + row + 1, i, i + row + 1, i + row});
    }
  return side;
}

/// A snapshot with the front of a unit square alone.
inline SolutionMesh squareMesh(SurfaceMesh side) {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.5f));
  addPolygon(scene, grey, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  SolutionMesh mesh;
  mesh.version = 1;
  mesh.scene = std::make_shared<const Scene>(std::move(scene));
  mesh.surfaces = {std::make_shared<const SurfaceMesh>(std::move(side)), nullptr};
  mesh.caustics = {nullptr, nullptr};
  return mesh;
}

}  // namespace deltalux::test
