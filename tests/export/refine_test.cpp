// Direct light measured on triangles: shadows are where they are, and triangles still fit together.
#include "export/refine.hpp"

#include <gtest/gtest.h>

#include <map>

#include "baked_scene.hpp"
#include "base/sobol.hpp"
#include "export/measured_direct.hpp"

namespace deltalux {
namespace {

using namespace exporting;

/// A floor of 4 x 4 m below a lamp of 20 cm, and a board of 1 x 0.6 m that stands askew between them.
Scene boardOverFloor() {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0), Emission{Rgb(100.0f), false, {}, {}});
  test::addPolygon(scene, grey, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  test::addPolygon(scene, grey, {{1.5, 1.6, 1}, {1.7, 2.3, 1}, {2.6, 2.1, 1}, {2.4, 1.4, 1}});
  test::addPolygon(scene, lamp, {{1.9, 1.9, 2.5}, {1.9, 2.1, 2.5}, {2.1, 2.1, 2.5}, {2.1, 1.9, 2.5}});
  addAreaLights(scene);
  return scene;
}

const Engine& board() {
  static const Engine engine = test::solved(boardOverFloor(), 0.05);
  return engine;
}

/// The floor as squares of two triangles, with no light at all.
LitSide coarseFloor() {
  const SurfaceMesh grid = test::gridSide(8, 4, [](double, double) { return Rgb(0.0f); });
  LitSide side;
  side.vertices = grid.vertices;
  for (std::size_t i = 0; i < grid.triangles.size(); i += 3)
    side.triangles.push_back({grid.triangles[i], grid.triangles[i + 1], grid.triangles[i + 2]});
  side.all.assign(1, std::vector<Rgb>(side.vertices.size(), Rgb(0.0f)));
  side.direct = side.all;
  return side;
}

LitSide refinedFloor() {
  LitSide side = coarseFloor();
  const Scene& scene = board().solution().get().scene;
  refine(side, scene[PrimitiveId(0)].shape, true, DirectLight::together(board().solution()),
         Refinement::of(scene, 0.03));
  return side;
}

TEST(Refine, LightIsWhatIsMeasuredBetweenCornersToo) {
  const LitSide side = refinedFloor();
  std::vector<Vec3f> corners;
  for (const MeshVertex& v : side.vertices) corners.push_back(v.position);
  const SideDirect light(std::move(corners), side.triangles, side.direct[0]);
  const DirectLight exact = DirectLight::together(board().solution());
  int off = 0, dark = 0;
  constexpr int kPlaces = 2000;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const UnitPair u = scrambledSobol(i, 11);
    const Vec3 p(4 * u.x, 4 * u.y, 0);
    const float there = gray(exact.at(0, p, {0, 0, 1}, 0, 0.005));
    const auto read = light.at(Vec3f(p), 1e-3f);
    ASSERT_TRUE(read.has_value());
    dark += there == 0;
    // Of what is there, or of half of what there is beside the shadow.
    off += std::abs(gray(*read) - there) > 0.06f * std::max(there, 0.3f);
  }
  EXPECT_GT(dark, 20);  // there is an umbra
  EXPECT_LT(off, kPlaces / 20);
}

TEST(Refine, TrianglesStillFitTogether) {
  const LitSide side = refinedFloor();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double area = 0;
  for (const auto& t : side.triangles) {
    const auto at = [&](std::size_t k) { return Vec3(side.vertices[t[k]].position); };
    const double twice = glm::cross(at(1) - at(0), at(2) - at(0)).z;
    EXPECT_GT(twice, -1e-6);  // corners are in single precision
    area += 0.5 * twice;
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  EXPECT_NEAR(area, 16, 1e-4);
  for (const auto& [ends, count] : edges) {
    if (count == 2) continue;
    EXPECT_EQ(count, 1);
    const Vec3f &a = side.vertices[ends.first].position, &b = side.vertices[ends.second].position;
    const bool outer = (a.x == b.x && (a.x == 0 || a.x == 4)) || (a.y == b.y && (a.y == 0 || a.y == 4));
    EXPECT_TRUE(outer) << a.x << ' ' << a.y << ' ' << b.x << ' ' << b.y;
  }
  EXPECT_GT(side.vertices.size(), 150u);
  EXPECT_LT(side.vertices.size(), 20000u);
}

TEST(Refine, KeepsTheTrianglesThatTexturesLieOn) {
  LitSide side = coarseFloor();
  const std::size_t vertices = side.vertices.size();
  const Scene& scene = board().solution().get().scene;
  Refinement settings = Refinement::of(scene, 0.03);
  settings.keepsShape = true;
  refine(side, scene[PrimitiveId(0)].shape, true, DirectLight::together(board().solution()), settings);
  EXPECT_EQ(side.vertices.size(), vertices);
  EXPECT_GT(gray(side.direct[0][0]), 0);
}

TEST(MeasuredLight, TakesThePlaceOfTheMeshsDirectLight) {
  const SolutionMesh mesh = test::meshOf(board());
  const MeasuredLight light = measuredLight(board().solution(), mesh, 0.03);
  const auto& side = light.mesh.surfaces[0];
  ASSERT_TRUE(light.sides[0]);
  for (std::size_t v = 0; v < side->vertices.size(); ++v) {
    EXPECT_TRUE(isBlack(side->vertices[v].direct));
    EXPECT_EQ(side->vertices[v].indirect, mesh.surfaces[0]->vertices[v].indirect);
  }
  const DirectLight exact = DirectLight::together(board().solution());
  for (const Vec3& p : {Vec3(0.3, 0.4, 0), Vec3(3.3, 3.1, 0), Vec3(2.0, 1.9, 0)}) {
    const float there = gray(exact.at(0, p, {0, 0, 1}, 0, 0.005));
    EXPECT_NEAR(gray(light.sides[0]->at(Vec3f(p), 1e-3f).value()), there, 0.06f * there);
  }
}

/// Whose share of direct light nobody knows where all lights were solved as one.
TEST(MeasuredLight, LeavesSkiesToTheMesh) {
  Scene scene = boardOverFloor();
  test::addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  const Engine engine = test::solved(std::move(scene), 0.1);
  const SolutionMesh mesh = test::meshOf(engine);
  const MeasuredLight light = measuredLight(engine.solution(), mesh, 0.05);
  EXPECT_FALSE(light.sides[0]);
  EXPECT_EQ(light.mesh.surfaces[0], mesh.surfaces[0]);
}

}  // namespace
}  // namespace deltalux
