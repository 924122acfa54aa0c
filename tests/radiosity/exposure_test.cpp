// What stands on a patch is not part of what light reaches of it.
#include "radiosity/exposure.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "support/solved.hpp"

namespace deltalux {
using namespace radiosity;

namespace {

using namespace test;

constexpr Vec3 kMiddle(1.88, 1.44, 0), kHalf(0.35, 0.4, 0);  // of the block's foot

/// About the block's middle.
Mat4 turn(double radians) {
  return glm::translate(Mat4(1.0), kMiddle) * glm::rotate(Mat4(1.0), radians, Vec3(0, 0, 1)) *
         glm::translate(Mat4(1.0), -kMiddle);
}
constexpr double kTurned = 0.5;

bool isBesideTheBlock(const Vec3& p) {
  const Vec3 d = glm::abs(Vec3(turn(-kTurned) * glm::dvec4(p, 1)) - kMiddle);
  return d.x > kHalf.x || d.y > kHalf.y;
}

/// A floor of 4 x 3 in a lit room, with a block of 0.7 x 0.8 on it that stands askew, so that no leaf ends at it.
Scene roomWithABlock() {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.6f));
  addBox(scene, grey, {0, 0, 0}, {4, 3, 2.5}, true);
  const std::size_t first = scene.primitives.size();
  addBox(scene, grey, kMiddle - kHalf, kMiddle + kHalf + Vec3(0, 0, 1.1), false);
  for (std::size_t i = first; i < scene.primitives.size(); ++i)
    scene.primitives[i].shape = *transformed(scene.primitives[i].shape, turn(kTurned));
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(10.0f), false, {}}),
             {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  return scene;
}

template <class Visit>
void forEachLeafOf(const Solution& s, PrimitiveId primitive, const Visit& visit) {
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    if (t.kind == hierarchy::ElementKind::Patch && t.childCount == 0 && t.front &&
        s.elements.domain[i].primitive == primitive)
      visit(s.elements.geometry[i], s.elements.radiometry[i]);
  }
}

PrimitiveId floorOf(const Scene& scene) {
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const SurfacePoint p = pointAt(scene.primitives[i].shape, {0.5, 0.5});
    if (p.position.z == 0 && p.normal.z > 0.5) return PrimitiveId(i);
  }
  return {};
}

TEST(Exposure, IsTheFloorWithoutWhatStandsOnIt) {
  const Engine engine = solved(roomWithABlock(), 0.1);
  const Solution& s = engine.solution().get();
  double lit = 0, area = 0;
  int partly = 0;
  forEachLeafOf(s, floorOf(s.scene), [&](const hierarchy::ElementGeometry& g, const hierarchy::ElementLight&) {
    lit += g.litArea(), area += g.area;
    partly += g.exposed < 1;
  });
  EXPECT_GT(partly, 3);
  EXPECT_NEAR(area, 12, 1e-4);
  // Leaves that are all under the block are dark and count as exposed.
  EXPECT_LT(lit, 12 - 0.02);
  EXPECT_GT(lit, 12 - 0.56 - 0.05);
}

// Leaves beside the block are as bright as the floor is there, not darker by the share that the block hides.
TEST(Exposure, WhatPeepsOutIsAsBrightAsItsSurroundings) {
  const Scene scene = roomWithABlock();
  const Engine engine = solved(scene, 0.05);
  const Solution& s = engine.solution().get();
  int compared = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    const hierarchy::ElementGeometry& g = s.elements.geometry[i];
    if (t.kind != hierarchy::ElementKind::Patch || t.childCount > 0 || !t.front || t.emitter || g.exposed >= 0.85f)
      continue;
    if (s.elements.domain[i].primitive != floorOf(s.scene) || g.exposed < 0.15f) continue;
    // Points of the leaf beside the block's foot.
    constexpr int kAcross = 16;
    std::vector<ProbePoint> points;
    for (int k = 0; k < kAcross * kAcross; ++k) {
      const Vec3 p(g.lower.x + (k % kAcross + 0.5) / kAcross * (g.upper.x - g.lower.x),
                   g.lower.y + (k / kAcross + 0.5) / kAcross * (g.upper.y - g.lower.y), 0);
      if (isBesideTheBlock(p)) points.push_back({p, {0, 0, 1}});
    }
    double mean = 0;
    for (const ProbeResult& r : measure(engine, points)) mean += gray(r.irradiance) / double(points.size());
    const hierarchy::ElementLight& l = s.elements.radiometry[i];
    EXPECT_NEAR(gray(l.direct + l.indirect), mean, 0.3 * mean) << i << ", exposed " << g.exposed;
    ++compared;
  }
  EXPECT_GT(compared, 2);
}

}  // namespace
}  // namespace deltalux
