// Patches of curved surfaces are bounded, and not much more than that.
#include <gtest/gtest.h>

#include <functional>

#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "support/solved.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

/// Calls check(elements, scene, leaf) for the leaves after so many splits of the shape's front.
void forEachPart(const Shape& shape, int splits,
                 const std::function<void(const Elements&, const Scene&, ElementId)>& check) {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  scene.objects.emplace_back().name = "shape";
  scene.primitives.push_back({shape, grey, ObjectId(0u)});
  Elements elements = buildElements(scene, surfaceSides(scene));
  std::vector<ElementId> parts{elements.side(PrimitiveId(0u), 0, true)};
  for (int k = 0; k < splits; ++k) {
    std::vector<ElementId> finer;
    for (const ElementId e : parts) {
      ASSERT_TRUE(subdivide(elements, scene, e));
      for (std::size_t c = 0; c < elements.at(e).childCount; ++c) finer.push_back(elements.child(e, c));
    }
    parts = std::move(finer);
  }
  for (const ElementId e : parts) check(elements, scene, e);
}

const Shape kShapes[] = {Cylinder{{0, 0, 0}, {28, 0, 0}, 0.11},    // a log
                         Cylinder{{0, 0, 0}, {0, 0, 0.006}, 1.3},  // the hem of a rug
                         Cone{{0, 0, 0}, {0, 3, 0}, 0.4, 0.1},     // a post
                         Ring{{0, 0, 0}, {0, 0, 1}, 0.2, 1.0},     // a disc with a hole
                         Sphere{{1, 2, 3}, 0.5}};

TEST(CurvedPatch, ItsBoxHoldsItsPoints) {
  for (const Shape& shape : kShapes)
    for (int splits = 0; splits <= 4; ++splits)
      forEachPart(shape, splits, [&](const Elements& elements, const Scene& scene, ElementId e) {
        const ElementGeometry& g = elements.shape(e);
        for (int i = 0; i <= 20; ++i)
          for (int j = 0; j <= 20; ++j) {
            const PatchPoint p = samplePatch(elements, scene, e, i / 20.0, j / 20.0);
            for (int axis = 0; axis < 3; ++axis) {
              EXPECT_GE(p.position[axis], g.lower[axis] - 1e-5f) << "kind " << shape.index() << ", splits " << splits;
              EXPECT_LE(p.position[axis], g.upper[axis] + 1e-5f) << "kind " << shape.index() << ", splits " << splits;
            }
            EXPECT_GE(glm::dot(p.normal, g.normal), g.normalCone - 1e-5f) << "kind " << shape.index();
          }
      });
}

TEST(CurvedPatch, ItsRadiusIsThatOfItsPoints) {
  for (const Shape& shape : kShapes)
    forEachPart(shape, 5, [&](const Elements& elements, const Scene& scene, ElementId e) {
      float widest = 0;
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j)
          widest = std::max(widest, glm::length(samplePatch(elements, scene, e, i / 8.0, j / 8.0).position -
                                                elements.shape(e).center));
      EXPECT_LT(elements.shape(e).radius, 1.5f * widest) << "kind " << shape.index();
    });
}

}  // namespace
}  // namespace deltalux
