#include <gtest/gtest.h>

#include "export/overlap.hpp"

namespace deltalux {
namespace {

using namespace exporting;

TEST(Overlap, MovesTheOutlineAndNothingElse) {
  PageMesh mesh;
  // A square as a fan; its middle is there twice, with light of its own on either side.
  for (const Vec3f& p :
       {Vec3f(0, 0, 2), Vec3f(1, 0, 2), Vec3f(1, 1, 2), Vec3f(0, 1, 2), Vec3f(0.5f, 0.5f, 2), Vec3f(0.5f, 0.5f, 2)}) {
    MeshVertex v;
    v.position = p;
    mesh.vertices.push_back(v);
  }
  mesh.triangles = {0, 1, 4, 1, 2, 4, 2, 3, 5, 3, 0, 5};
  mesh.sides = {{0, 0, 6, 0}};
  mesh.draws = {PageDraw{}};
  mesh.draws[0].count = 12;
  widenSides(mesh, 0.01);
  EXPECT_NEAR(mesh.vertices[0].position.x, -0.01, 1e-6);
  EXPECT_NEAR(mesh.vertices[0].position.y, -0.01, 1e-6);
  EXPECT_NEAR(mesh.vertices[2].position.x, 1.01, 1e-6);
  EXPECT_EQ(mesh.vertices[4].position, Vec3f(0.5f, 0.5f, 2));
  EXPECT_EQ(mesh.vertices[5].position, Vec3f(0.5f, 0.5f, 2));
  EXPECT_EQ(mesh.vertices[1].position.z, 2);
}

}  // namespace
}  // namespace deltalux
