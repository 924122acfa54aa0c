// Patches of many faces: they part a mesh, know their faces, and are sampled evenly by area.
#include "hierarchy/face_order.hpp"

#include <gtest/gtest.h>

#include <set>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/leaf_locator.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/side_locator.hpp"
#include "support/fine_meshes.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

double hills(double x, double y) { return 0.3 * std::sin(3 * x) * std::cos(2 * y); }

bool holds(const Box& box, const Vec3& p, double slack) {
  return Box{box.lower - slack, box.upper + slack}.contains(p);
}

struct Meshed {
  explicit Meshed(Shape shape) {
    test::addShape(scene, test::addMaterial(scene, "white", test::lambert(0.5f)), std::move(shape));
    std::vector<FaceOrder> orders = faceOrders(scene);
    const std::vector<SurfaceSide> sides = surfaceSides(scene, orders);
    elements = buildElements(scene, sides, std::move(orders));
  }
  const Mesh& mesh() const { return std::get<Mesh>(scene.primitives[0].shape); }
  /// Splits all patches so many times.
  void refine(int levels) {
    for (int level = 0; level < levels; ++level)
      for (std::size_t i = 0, n = elements.size(); i < n; ++i)
        if (const ElementId e(i); elements.isPatch(e) && elements.isLeaf(e)) subdivide(elements, scene, e);
  }

  Scene scene;
  Elements elements;
};

TEST(FaceOrder, InputsPartTheMeshByTheWayThatItsFacesLook) {
  for (const std::uint32_t n : {16u, 64u, 200u}) {
    const Mesh mesh = test::ball({1, 2, 3}, 0.5, n);
    const FaceOrder order(PrimitiveId(0), mesh);
    std::vector<FaceRange> inputs = order.inputs();
    EXPECT_GE(inputs.size(), 6u);
    EXPECT_LE(inputs.size(), 400u) << n;
    std::uint32_t next = 0;
    double whole = 0;
    for (const FaceRange& r : inputs) {
      EXPECT_EQ(r.first, next);
      next += r.count, whole += order.area(r);
      std::set<int> ways;
      for (std::uint32_t i = r.first; i < r.first + r.count; ++i) {
        EXPECT_EQ(order.placeOf(order.faceAt(i)), i);
        const auto& [a, b, c] = mesh.triangles[order.faceAt(i)];
        const Vec3 v = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]),
                   s = glm::abs(v);
        const int axis = s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2;
        ways.insert(2 * axis + (v[axis] < 0));
      }
      EXPECT_EQ(ways.size(), 1u);
    }
    EXPECT_EQ(next, mesh.triangles.size());
    EXPECT_NEAR(whole / area(Shape(mesh)), 1, 1e-12);
  }
}

TEST(FaceOrder, PartsAreWhatTheyPart) {
  const FaceOrder order(PrimitiveId(0), test::ground(2, 40, hills));
  std::vector<FaceRange> open = order.inputs();
  std::size_t single = 0;
  while (!open.empty()) {
    const FaceRange r = open.back();
    open.pop_back();
    if (r.count == 1) {
      ++single;
      continue;
    }
    const std::vector<FaceRange> parts = order.parts(r);
    ASSERT_GE(parts.size(), 2u);
    ASSERT_LE(parts.size(), 4u);
    std::uint32_t next = r.first;
    for (const FaceRange& p : parts) {
      ASSERT_EQ(p.first, next);
      ASSERT_GT(p.count, 0u);
      next += p.count, open.push_back(p);
    }
    ASSERT_EQ(next, r.first + r.count);
  }
  EXPECT_EQ(single, order.faces());
}

TEST(FaceOrder, CoincidentFacesAreParted) {
  // All centres fall into one cell of the curve.
  std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const FaceOrder order(PrimitiveId(0),
                        *makeMesh(positions, std::vector<std::array<std::uint32_t, 3>>(700, {0, 1, 2})));
  std::uint32_t faces = 0;
  for (const FaceRange& r : order.inputs()) faces += r.count;
  EXPECT_EQ(faces, 700u);
}

TEST(FacesPatch, EverySideIsHeldByTheLowestPatchWithAllOfIt) {
  Meshed m(test::ground(2, 24, hills));
  for (int level = 0; level < 6; ++level) {
    ASSERT_NO_THROW(validate(m.elements));
    const SideLocator locator(m.elements, m.scene);
    const LeafTable leaves(m.elements);
    const LeafLocator numbers(m.elements, m.scene, leaves);
    std::vector<double> held(m.elements.size(), 0.0);
    for (std::uint32_t t = 0; t < m.mesh().triangles.size(); ++t)
      for (const bool front : {true, false}) {
        const auto& [a, b, c] = m.mesh().triangles[t];
        const Vec3 &p = m.mesh().positions[a], &q = m.mesh().positions[b], &r = m.mesh().positions[c];
        const ElementId side = locator.side(PrimitiveId(0), t, front);
        ASSERT_TRUE(side.valid());
        EXPECT_EQ(m.elements.at(side).front, front);
        EXPECT_EQ(m.elements.at(surfaceOf(m.elements, side)).depth, 0);
        const Vec3 x = 0.5 * p + 0.2 * q + 0.3 * r;
        const ElementId leaf = locator.locate(side, x).leaf;
        EXPECT_TRUE(m.elements.isLeaf(leaf));
        EXPECT_TRUE(holds(m.elements.box(leaf), x, 1e-5)) << level;
        EXPECT_EQ(numbers.at({PrimitiveId(0), t, front}, Vec3f(x)), leaves.indexOf[leaf.index()]);
        if (m.elements.hasFaces(leaf)) held[leaf.index()] += 0.5 * glm::length(glm::cross(q - p, r - p));
      }
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i] > 0) {
        EXPECT_NEAR(held[i] / m.elements.geometry[i].area, 1, 1e-4);
      }
    m.refine(1);
  }
  // Down to parts of faces.
  std::size_t flat = 0;
  for (std::size_t i = 0; i < m.elements.size(); ++i)
    flat += m.elements.isReceivingLeaf(ElementId(i)) && m.elements.topology[i].flat;
  EXPECT_GE(flat, 2 * m.mesh().triangles.size());
}

TEST(FacesPatch, ListsAreTheSameAfterTheyAreListedAnew) {
  Meshed m(test::ball({0, 0, 0}, 1, 20));
  m.refine(3);
  const SideTable<ElementId> before = m.elements.sides;
  m.elements.listInputs();
  for (std::uint32_t t = 0; t < m.mesh().triangles.size(); ++t)
    for (const bool front : {true, false})
      EXPECT_EQ(m.elements.sides.at({PrimitiveId(0), t, front}), before.at({PrimitiveId(0), t, front}));
}

TEST(FacesPatch, BoundsHoldItsPointsAndNormals) {
  Meshed m(test::ball({1, 0, 0}, 1, 24));
  m.refine(1);
  int patches = 0;
  for (std::size_t i = 0; i < m.elements.size(); ++i) {
    const ElementId e(i);
    if (!m.elements.isPatch(e) || !m.elements.hasFaces(e)) continue;
    const ElementGeometry& g = m.elements.shape(e);
    ++patches;
    for (int k = 0; k < 64; ++k) {
      const PatchPoint p =
          samplePatch(m.elements, m.scene, e, (k + 0.5) / 64, toUnit(combineKeys(i, std::uint64_t(k))));
      EXPECT_LE(glm::length(p.position - g.center), g.radius * 1.0001f);
      EXPECT_TRUE(holds(m.elements.box(e), Vec3(p.position), 1e-5));
      EXPECT_GE(glm::dot(p.normal, g.normal), g.normalCone - 1e-5f);
      EXPECT_GT(glm::dot(p.normal, p.position - Vec3f(1, 0, 0)) * (m.elements.at(e).front ? 1 : -1), 0);
    }
  }
  EXPECT_GT(patches, 20);
}

TEST(FacesPatch, IsSampledEvenlyByArea) {
  // Steeper, so with more area, to the right.
  Meshed m(test::ground(1, 30, [](double x, double) { return x * x; }));
  double sum = 0, area = 0;
  for (const ElementId e : m.elements.inputs) {
    if (!m.elements.hasFaces(e) || !m.elements.at(e).front) continue;
    constexpr int kPoints = 4096;
    double mean = 0;
    for (int k = 0; k < kPoints; ++k)
      mean += samplePatch(m.elements, m.scene, e, (k + 0.5) / kPoints, toUnit(mix64(std::uint64_t(k)))).position.x /
              kPoints;
    EXPECT_NEAR(mean, m.elements.shape(e).center.x, 0.003);
    sum += mean * m.elements.shape(e).area, area += m.elements.shape(e).area;
  }
  // Integrals of x sqrt(1 + 4 x^2) and of the root alone.
  const double whole = std::sqrt(5.0) / 2 + std::asinh(2.0) / 4;
  EXPECT_NEAR(area / whole, 1, 1e-3);
  EXPECT_NEAR(sum / area, (std::pow(5.0, 1.5) - 1) / 12 / whole, 0.002);
}

}  // namespace
}  // namespace deltalux
