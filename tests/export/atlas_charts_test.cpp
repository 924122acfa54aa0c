// Charts: every triangle of a lit side once, flat, as large as it is, and not over another.
#include "export/atlas_charts.hpp"

#include <gtest/gtest.h>

#include <map>

#include "baked_scene.hpp"
#include "export/atlas_regions.hpp"

namespace deltalux::exporting {
namespace {

double areaInChart(const AtlasChart& chart, std::size_t t) {
  const Vec2 a = chart.places[chart.corners[3 * t]];
  const Vec2 u = chart.places[chart.corners[3 * t + 1]] - a, v = chart.places[chart.corners[3 * t + 2]] - a;
  return 0.5 * (u.x * v.y - u.y * v.x);
}

TEST(AtlasCharts, HoldEveryTriangleOfEveryLitSideOnce) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  const std::vector<AtlasChart> charts = litCharts(mesh, test::kCrease);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> times;
  for (const AtlasChart& c : charts)
    for (const std::uint32_t t : c.triangles) ++times[{c.side, t}];
  std::size_t expected = 0;
  for (std::size_t side = 0; side < mesh.surfaces.size(); ++side) {
    if (!isLit(mesh, side)) continue;
    expected += mesh.surfaces[side]->triangles.size() / 3;
    for (std::uint32_t t = 0; t < mesh.surfaces[side]->triangles.size() / 3; ++t)
      EXPECT_EQ((times[{static_cast<std::uint32_t>(side), t}]), 1) << side << " " << t;
  }
  EXPECT_EQ(times.size(), expected);
  EXPECT_GT(expected, 1000u);
}

TEST(AtlasCharts, OfOneSideDoNotCoverThemselvesAndFaceTheSameWay) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  for (const AtlasChart& c : litCharts(mesh, test::kCrease)) {
    EXPECT_FALSE(coversItself(c)) << c.side;
    const Shape& shape = (*mesh.scene).primitives[c.side / 2].shape;
    if (std::holds_alternative<Sphere>(shape) || std::holds_alternative<Cylinder>(shape) ||
        std::holds_alternative<Cone>(shape))
      continue;
    for (std::size_t t = 0; t < c.triangles.size(); ++t) EXPECT_GE(areaInChart(c, t), -1e-9);
  }
}

TEST(AtlasCharts, OfFlatSidesHaveTheirAreas) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  int flat = 0;
  for (const AtlasChart& c : litCharts(mesh, test::kCrease)) {
    const SurfaceMesh& side = *mesh.surfaces[c.side];
    if (!std::holds_alternative<Polygon>((*mesh.scene)[side.primitive].shape)) continue;
    ++flat;
    for (std::size_t t = 0; t < c.triangles.size(); ++t)
      EXPECT_NEAR(areaInChart(c, t), 0.5 * glm::length(areaNormal(side, c.triangles[t])), 1e-6);
  }
  EXPECT_GE(flat, 5);
}

TEST(AtlasCharts, LieAlongTheirLongestEdges) {
  SurfaceMesh side = test::gridSide(4, 1, [](double, double) { return Rgb(1.0f); });
  for (MeshVertex& v : side.vertices) {
    const float x = 2 * v.position.x, y = v.position.y;
    v.position = Vec3f(0.8f * x - 0.6f * y, 0.6f * x + 0.8f * y, 3);
  }
  const auto charts = chartsOf(side, Shape(*makePolygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})), test::kCrease);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_NEAR(std::max(charts[0].size.x, charts[0].size.y), 2, 1e-5);
  EXPECT_NEAR(std::min(charts[0].size.x, charts[0].size.y), 1, 1e-5);
}

/// The side of a mesh as it is.
SurfaceMesh sideOf(const Mesh& mesh) {
  SurfaceMesh side;
  side.primitive = PrimitiveId(0);
  for (const Vec3& p : mesh.positions) {
    MeshVertex v;
    v.position = Vec3f(p), v.direct = Rgb(1.0f);
    side.vertices.push_back(v);
  }
  for (const auto& t : mesh.triangles) side.triangles.insert(side.triangles.end(), t.begin(), t.end());
  return side;
}

TEST(AtlasCharts, CutABoxAtItsEdges) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  const Mesh box = *makeMesh(corners, {{0, 2, 1},
                                       {1, 2, 3},
                                       {4, 5, 6},
                                       {5, 7, 6},
                                       {0, 1, 4},
                                       {1, 5, 4},
                                       {2, 6, 3},
                                       {3, 6, 7},
                                       {0, 4, 2},
                                       {2, 4, 6},
                                       {1, 3, 5},
                                       {3, 7, 5}});
  const auto charts = chartsOf(sideOf(box), Shape(box), test::kCrease);
  EXPECT_EQ(charts.size(), 6u);
  for (const AtlasChart& c : charts) EXPECT_NEAR(glm::length(c.size - Vec2(1)), 0, 1e-6);
}

TEST(AtlasCharts, PartTrianglesThatLieOnEachOther) {
  const Mesh twice = *makeMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}, {1.2, 0.2, 0}, {0.2, 1.2, 0}},
                               {{0, 1, 2}, {3, 4, 5}, {0, 1, 5}});
  for (const AtlasChart& c : chartsOf(sideOf(twice), Shape(twice), test::kCrease)) EXPECT_FALSE(coversItself(c));
}

TEST(AtlasCharts, UnrollACylinderByItsLengths) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  int seen = 0;
  for (const AtlasChart& c : litCharts(mesh, test::kCrease)) {
    const auto* cylinder = std::get_if<Cylinder>(&(*mesh.scene).primitives[c.side / 2].shape);
    if (!cylinder) continue;
    ++seen;
    EXPECT_NEAR(c.size.x, 2 * kPi * cylinder->radius, 1e-3);
    EXPECT_NEAR(c.size.y, glm::length(cylinder->p1 - cylinder->p0), 1e-3);
  }
  EXPECT_GE(seen, 1);
}

}  // namespace
}  // namespace deltalux::exporting
