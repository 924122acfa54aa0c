#include "io/planar_faces.hpp"

#include <gtest/gtest.h>

#include "hierarchy/tuning.hpp"

namespace deltalux {
using namespace io;

namespace {

double totalArea(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const Shape& shape : shapes) sum += area(shape);
  return sum;
}

Mesh boxMesh() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(Vec3(i & 1, 2 * ((i >> 1) & 1), 3 * (i >> 2)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(PlanarFaces, ABoxIsSixRectangles) {
  const std::vector<Shape> shapes = planarFaces(boxMesh());
  ASSERT_EQ(shapes.size(), 6u);
  EXPECT_NEAR(totalArea(shapes), 2 * (2 + 3 + 6), 1e-12);
  for (const Shape& shape : shapes) {
    const auto& polygon = std::get<Polygon>(shape);
    EXPECT_EQ(polygon.vertices.size(), 4u);
    EXPECT_GT(glm::dot(polygon.normal, polygon.vertices[0] - Vec3(0.5, 1, 1.5)), 0);  // outwards
  }
}

TEST(PlanarFaces, VerticesOfTheirOwnPerFaceAndPointsOnEdgesDoNotMatter) {
  Mesh mesh;  // an L of four triangles, no vertex shared, one point in the middle of a straight side
  const std::vector<Vec3> l{{0, 0, 5}, {1, 0, 5}, {2, 0, 5}, {2, 1, 5}, {1, 1, 5}, {1, 2, 5}, {0, 2, 5}};
  for (const auto& t : {std::array{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 4, 6}, {4, 5, 6}}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const int corner : t) mesh.positions.push_back(l[static_cast<std::size_t>(corner)]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const std::vector<Shape> shapes = planarFaces(mesh);
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_EQ(std::get<Polygon>(shapes[0]).vertices.size(), 6u);
  EXPECT_NEAR(totalArea(shapes), 3, 1e-12);
}

TEST(PlanarFaces, AFrameWithAHoleStaysAMesh) {
  Mesh mesh;
  for (const double r : {1.0, 2.0}) {
    for (const auto& [x, y] : {std::pair{-r, -r}, {r, -r}, {r, r}, {-r, r}}) mesh.positions.push_back({x, y, 0});
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t next = (i + 1) % 4;
    mesh.triangles.push_back({i + 4, next + 4, i});
    mesh.triangles.push_back({next + 4, next, i});
  }
  const std::vector<Shape> shapes = planarFaces(mesh);
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Mesh>(shapes[0]));
  EXPECT_NEAR(totalArea(shapes), 12, 1e-12);
}

TEST(PlanarFaces, BothSidesOfASheetStay) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
  const std::vector<Shape> shapes = planarFaces(mesh);
  EXPECT_NEAR(totalArea(shapes), 2, 1e-12);
  Vec3 sum(0);
  for (const Shape& shape : shapes) sum += std::get<Polygon>(shape).normal * area(shape);
  EXPECT_NEAR(glm::length(sum), 0, 1e-12);
}

TEST(PlanarFaces, CurvedShadedTexturedOrLargeMeshesStayMeshes) {
  const auto staysMesh = [](Mesh mesh) {
    const std::vector<Shape> shapes = planarFaces(std::move(mesh));
    return shapes.size() == 1 && std::holds_alternative<Mesh>(shapes[0]);
  };
  Mesh shaded = boxMesh();
  for (const Vec3& p : shaded.positions) shaded.normals.push_back(glm::normalize(p - Vec3(0.5, 1, 1.5)));
  EXPECT_TRUE(staysMesh(shaded));
  Mesh textured = boxMesh();
  textured.texcoords.resize(textured.positions.size());
  EXPECT_TRUE(staysMesh(textured));
  Mesh large;
  for (std::uint32_t i = 0; i <= hierarchy::tuning::kInputs; ++i) {
    for (const Vec3& p : {Vec3(0, 0, i), Vec3(1, 0, i), Vec3(0, 1, i)}) large.positions.push_back(p);
    large.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_TRUE(staysMesh(large));
}

TEST(PlanarFaces, ABendIsKept) {
  Mesh mesh;  // two triangles one degree out of plane
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.0174}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(planarFaces(mesh).size(), 2u);
}

}  // namespace
}  // namespace deltalux
