#include "mesh_pick.hpp"

#include <gtest/gtest.h>

namespace deltalux::viewer {
namespace {

/// A square of two triangles at the height z, seen from above or from below.
std::shared_ptr<const SurfaceMesh> square(std::size_t primitive, bool front, float z, float brightness) {
  SurfaceMesh side;
  side.primitive = PrimitiveId(primitive), side.front = front;
  side.shapeVersion = 1;
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
    MeshVertex v;
    v.position = {x, y, z};
    v.direct = Rgb(x * brightness), v.indirect = Rgb(y * brightness), v.particle = Rgb(brightness);
    side.vertices.push_back(v);
  }
  side.triangles = front ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2};
  return std::make_shared<const SurfaceMesh>(side);
}

SolutionMesh twoSquares() {
  auto scene = std::make_shared<Scene>();
  scene->materials.emplace_back();
  for (const double z : {0.0, 1.0})
    scene->primitives.push_back(
        {*makePolygon({{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}), MaterialId(0), ObjectId()});
  SolutionMesh mesh;
  mesh.version = 1;
  mesh.scene = scene;
  mesh.surfaces = {square(0, true, 0, 4), square(0, false, 0, 8), square(1, true, 1, 16), square(1, false, 1, 32)};
  mesh.caustics.resize(4);
  return mesh;
}

TEST(ViewerMeshPick, FindsTheNearestSideThatFacesTheRay) {
  MeshPick pick;
  pick.follow(std::make_shared<const SolutionMesh>(twoSquares()));
  const auto above = pick.first({0.25, 0.5, 3}, {0, 0, -1}, {});
  ASSERT_TRUE(above);
  EXPECT_EQ(above->surface.primitive, PrimitiveId(1));
  EXPECT_TRUE(above->surface.front);
  EXPECT_NEAR(above->surface.distance, 2, 1e-9);
  EXPECT_NEAR(above->surface.normal.z, 1, 1e-9);
  EXPECT_NEAR(above->irradiance.r, 16 * (0.25 + 0.5 + 1), 1e-4);
  const auto between = pick.first({0.5, 0.5, 0.5}, {0, 0, 1}, {});
  ASSERT_TRUE(between);
  EXPECT_EQ(between->surface.primitive, PrimitiveId(1));
  EXPECT_FALSE(between->surface.front);
  EXPECT_NEAR(between->surface.normal.z, -1, 1e-9);
  EXPECT_FALSE(pick.first({1.5, 0.5, 3}, {0, 0, -1}, {}));
  EXPECT_FALSE(pick.first({0.5, 0.5, 3}, {0, 0, 1}, {}));
}

TEST(ViewerMeshPick, SeesWhatTheSectionLeaves) {
  MeshPick pick;
  pick.follow(std::make_shared<const SolutionMesh>(twoSquares()));
  const Box low{{-1, -1, -1}, {2, 2, 0.5}};
  const auto hit = pick.first({0.5, 0.5, 3}, {0, 0, -1}, low);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->surface.primitive, PrimitiveId(0));
}

TEST(ViewerMeshPick, FollowsShapesThatMovedAndSidesThatWent) {
  MeshPick pick;
  SolutionMesh mesh = twoSquares();
  pick.follow(std::make_shared<const SolutionMesh>(mesh));
  SurfaceMesh moved = *mesh.surfaces[2];
  for (MeshVertex& v : moved.vertices) v.position.x += 5;
  moved.shapeVersion = mesh.version = 2;
  mesh.surfaces[2] = std::make_shared<const SurfaceMesh>(moved);
  pick.follow(std::make_shared<const SolutionMesh>(mesh));
  EXPECT_EQ(pick.first({0.5, 0.5, 3}, {0, 0, -1}, {})->surface.primitive, PrimitiveId(0));
  EXPECT_EQ(pick.first({5.5, 0.5, 3}, {0, 0, -1}, {})->surface.primitive, PrimitiveId(1));
  mesh.surfaces[2] = nullptr;
  pick.follow(std::make_shared<const SolutionMesh>(mesh));
  EXPECT_FALSE(pick.first({5.5, 0.5, 3}, {0, 0, -1}, {}));
}

TEST(ViewerMeshPick, PointsOfCurvedShapesLieOnThem) {
  SolutionMesh mesh = twoSquares();
  auto scene = std::make_shared<Scene>(*mesh.scene);
  scene->primitives[1].shape = Sphere{{0.5, 0.5, -1}, 2};  // of which the square at z = 1 is a coarse piece
  mesh.scene = scene;
  MeshPick pick;
  pick.follow(std::make_shared<const SolutionMesh>(mesh));
  const auto hit = pick.first({0.9, 0.8, 3}, {0, 0, -1}, {});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(glm::length(hit->surface.position - Vec3(0.5, 0.5, -1)), 2, 1e-9);
  EXPECT_NEAR(glm::dot(hit->surface.normal, hit->surface.position - Vec3(0.5, 0.5, -1)), 2, 1e-9);
}

}  // namespace
}  // namespace deltalux::viewer
