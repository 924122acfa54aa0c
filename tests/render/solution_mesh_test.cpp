// The triangles of solution meshes: all of every side, once, the right way round, and without T-vertices.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/solution_reader.hpp>
#include <map>
#include <tuple>

#include "base/random.hpp"
#include "caustics/shapes.hpp"
#include "hierarchy/patch.hpp"
#include "mesh_scenes.hpp"
#include "render/solution_mesh/plane_groups.hpp"
#include "render/solution_mesh/side_shape.hpp"

namespace deltalux {
using namespace rendering;

namespace {

using test::MeshScene;
using test::polygon;
using test::square;

/// Every side's shape, side by side.
std::vector<std::shared_ptr<const SideShape>> allShapes(const MeshScene& mesh) {
  std::vector<std::shared_ptr<const SideShape>> all(2 * mesh.scene.primitives.size());
  for (const auto& group : planeGroups(mesh.scene)) {
    std::vector<SurfacePieces> pieces;
    for (const std::uint32_t side : group)
      pieces.push_back(piecesOf(mesh.elements, mesh.scene, PrimitiveId(side / 2), side % 2 == 0));
    std::vector<const SurfacePieces*> sides;
    for (const SurfacePieces& p : pieces) sides.push_back(&p);
    const auto made = shapesOf(sides, mesh.scene, touchingDistance(mesh.scene, group));
    for (std::size_t i = 0; i < group.size(); ++i) all[group[i]] = made[i];
  }
  return all;
}

Vec3 positionAt(const SideShape& s, std::size_t index) { return Vec3(s.points[s.triangles[index]].position); }

double areaOf(const SideShape& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.triangles.size(); i += 3) {
    const Vec3 a = positionAt(s, i), b = positionAt(s, i + 1), c = positionAt(s, i + 2);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

using Place = std::tuple<float, float, float>;
Place placeOf(const Vec3f& p) { return {p.x, p.y, p.z}; }

/// Edges of triangles by where they run, and how many run so.
std::map<std::pair<Place, Place>, int> edgesOf(const std::vector<const SideShape*>& shapes) {
  std::map<std::pair<Place, Place>, int> edges;
  for (const SideShape* s : shapes)
    for (std::size_t i = 0; i < s->triangles.size(); i += 3)
      for (std::size_t k = 0; k < 3; ++k)
        ++edges[{placeOf(s->points[s->triangles[i + k]].position),
                 placeOf(s->points[s->triangles[i + (k + 1) % 3]].position)}];
  return edges;
}

/// Edges that have no triangle on their other side.
std::vector<std::pair<Vec3, Vec3>> rims(const std::vector<const SideShape*>& shapes) {
  const auto edges = edgesOf(shapes);
  std::vector<std::pair<Vec3, Vec3>> result;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    const auto at = [](const Place& p) { return Vec3(std::get<0>(p), std::get<1>(p), std::get<2>(p)); };
    if (!edges.contains({edge.second, edge.first})) result.push_back({at(edge.first), at(edge.second)});
  }
  return result;
}

class MeshOf : public testing::TestWithParam<test::NamedShape> {
 protected:
  MeshScene mesh_ = [] {
    MeshScene mesh({{GetParam().shape, MaterialId(0), ObjectId()}});
    mesh.splitIrregularly(1, 6, 3);
    return mesh;
  }();
  double size_ = bounds(GetParam().shape).diagonal();
};

TEST_P(MeshOf, HasTheAreaOfTheSurfaceOnBothSides) {
  const Shape& shape = GetParam().shape;
  const bool flat = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Mesh>(shape);
  const auto shapes = allShapes(mesh_);
  ASSERT_EQ(shapes.size(), 2u);
  for (const auto& side : shapes) {
    // 64 steps round: 1 - sin(x) / x with x = 2 pi / 64 is 0.0016, twice that for spheres.
    EXPECT_NEAR(areaOf(*side) / area(shape), 1.0, flat ? 1e-5 : 0.004);
    EXPECT_LE(areaOf(*side) / area(shape), 1.0 + 1e-5);
  }
}

TEST_P(MeshOf, FacesOutOfItsSide) {
  for (const auto& side : allShapes(mesh_))
    for (std::size_t i = 0; i < side->triangles.size(); i += 3) {
      const Vec3 a = positionAt(*side, i), n = glm::cross(positionAt(*side, i + 1) - a, positionAt(*side, i + 2) - a);
      for (std::size_t k = 0; k < 3; ++k) {
        const MeshVertex& v = side->points[side->triangles[i + k]];
        EXPECT_GT(glm::dot(n, Vec3(v.normal)), 0.0);
        EXPECT_NEAR(glm::length(v.normal), 1.0f, 1e-5f);
      }
    }
}

TEST_P(MeshOf, CoversEveryPoint) {
  const auto shapes = allShapes(mesh_);
  Rng rng(11);
  for (int i = 0; i < 300; ++i) {
    const double u = rng.uniform();
    const SurfacePoint p = samplePoint(GetParam().shape, {u, rng.uniform()});
    for (const bool front : {true, false}) {
      const SideShape& s = *shapes[front ? 0 : 1];
      int over = 0;
      for (std::size_t t = 0; t < s.triangles.size(); t += 3) {
        const Vec3 a = positionAt(s, t), b = positionAt(s, t + 1), c = positionAt(s, t + 2),
                   n = glm::cross(b - a, c - a);
        if (std::abs(glm::dot(p.position - a, glm::normalize(n))) > 2e-3 * size_) continue;
        const auto beside = [&](const Vec3& from, const Vec3& to) {
          return glm::dot(glm::cross(to - from, p.position - from), n) / glm::dot(n, n);
        };
        over += beside(a, b) > -1e-6 && beside(b, c) > -1e-6 && beside(c, a) > -1e-6;
      }
      EXPECT_GE(over, 1) << p.position.x << " " << p.position.y << " " << p.position.z;
      EXPECT_LE(over, 2);  // on an edge
    }
  }
}

/// Every edge is a triangle's on either side, but for those along the surface's own rim.
TEST_P(MeshOf, HasNoTVertices) {
  const Shape& shape = GetParam().shape;
  for (const auto& side : allShapes(mesh_)) {
    const auto open = rims({side.get()});
    double rim = 0;
    for (const auto& [a, b] : open) rim += glm::distance(a, b);
    double expected = 0;
    if (const auto* p = std::get_if<Polygon>(&shape)) {
      for (std::size_t i = 0; i < p->vertices.size(); ++i)
        expected += glm::distance(p->vertices[i], p->vertices[(i + 1) % p->vertices.size()]);
    } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      expected = 4 * kPi * cylinder->radius;
    } else if (const auto* cone = std::get_if<Cone>(&shape)) {
      expected = 2 * kPi * (cone->radius0 + cone->radius1);
    } else if (const auto* ring = std::get_if<Ring>(&shape)) {
      expected = 2 * kPi * (ring->innerRadius + ring->outerRadius);
    }
    EXPECT_NEAR(rim, expected, 2e-3 * expected + 1e-9);
  }
}

TEST_P(MeshOf, OutlinesTheLeaves) {
  const auto shapes = allShapes(mesh_);
  std::size_t leaves = 0, outlined = 0;
  for (std::size_t i = 0; i < mesh_.elements.size(); ++i)
    leaves += mesh_.elements.isReceivingLeaf(hierarchy::ElementId(i));
  std::map<hierarchy::ElementId, int> found;
  for (const auto& side : shapes)
    for (const SideShape::Part& part : side->parts)
      if (part.leaf.valid() && part.outlinesEnd > part.outlines) ++found[part.leaf];
  outlined = found.size();
  EXPECT_EQ(outlined, leaves);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MeshOf, testing::ValuesIn(test::causticShapes()),
                         [](const auto& shape) { return shape.param.name; });

/// Two floors side by side, the third turned over, and a wall: floors share the points where they touch.
TEST(SolutionMesh, SharesPointsAcrossPolygonsOfOnePlane) {
  MeshScene mesh({square(0, 0), square(1, 0.25), polygon({{0, 1, 0}, {0, 2, 0}, {1, 2, 0}, {1, 1, 0}}),
                  polygon({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}})});
  mesh.splitIrregularly(1, 5, 7);
  const auto shapes = allShapes(mesh);
  // Above: fronts of the first two, back of the third.
  const auto open = rims({shapes[0].get(), shapes[2].get(), shapes[5].get()});
  double rim = 0;
  for (const auto& [a, b] : open) rim += glm::distance(a, b);
  EXPECT_NEAR(rim, 3 * 4 - 2 * (0.75 + 1 + 0.25), 1e-5);
}

TEST(SolutionMesh, SmoothMeshesShareVerticesAndCreasedOnesDoNot) {
  std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const Mesh creased = *makeMesh(positions, triangles);
  const Mesh smooth = *makeMesh(positions, triangles, std::vector<Vec3>(4, glm::normalize(Vec3(0, -0.2, 1))));
  const auto count = [](const Mesh& m) {
    const MeshScene mesh({{m, MaterialId(0), ObjectId()}});
    return allShapes(mesh)[0]->points.size();
  };
  EXPECT_EQ(count(creased), 6u);
  EXPECT_EQ(count(smooth), 4u);
}

TEST(SolutionMesh, LargeCurvedSurfacesGetMoreSteps) {
  const auto triangles = [](double radius) {
    const MeshScene mesh(
        {{Cylinder{{0, 0, 0}, {0, 0, 1}, radius}, MaterialId(0), ObjectId()}, square(-100, -100, 200)});
    return allShapes(mesh)[0]->triangles.size();
  };
  EXPECT_GT(triangles(60), triangles(0.1));
}

}  // namespace
}  // namespace deltalux
