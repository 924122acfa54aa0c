// Properties that every diffuse solution must have, whatever the scene.
#include <gtest/gtest.h>
#include <deltalux/engine.hpp>
#include <deltalux/render.hpp>

#include "solution/solution.hpp"
#include "support/boxes.hpp"

namespace deltalux {
namespace {

template <class Check>
void forEachLeaf(const Solution& s, const Check& check) {
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (s.elements.isReceivingLeaf(hierarchy::ElementId(i))) check(hierarchy::ElementId(i));
  }
}

Scene furnace(float rho) {
  Scene scene;
  const MaterialId wall = test::addMaterial(scene, "wall", Rgb(rho), Rgb(1.0f));
  test::addBox(scene, "room", wall, {0, 0, 0}, {1, 1.5, 0.8}, true);
  return scene;
}

class Furnace : public testing::TestWithParam<float> {};

/// Closed, every wall M = pi and rho: E = pi / (1 - rho) everywhere. [CIE 171]
TEST_P(Furnace, IsTheSameEverywhere) {
  const double exact = kPi / (1 - GetParam());
  Engine engine(furnace(GetParam()));
  EXPECT_TRUE(engine.solve().converged);
  const Solution& s = engine.solution().get();
  double sum = 0, area = 0;
  forEachLeaf(s, [&](hierarchy::ElementId e) {
    if (!s.elements.at(e).front) return;
    const hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    EXPECT_NEAR((l.direct + l.indirect).g, exact, 0.005 * exact);
    sum += double(s.elements.geometry[e.index()].area) * (l.direct + l.indirect).g;
    area += s.elements.geometry[e.index()].area;
  });
  EXPECT_NEAR(sum / area, exact, 0.002 * exact);
  EXPECT_NO_THROW(validate(s.elements));

  std::vector<ProbePoint> points;
  for (const Primitive& wall : s.scene.primitives)
    for (const Vec2& uv : {Vec2(0.02, 0.03), Vec2(0.5, 0.5), Vec2(0.31, 0.9)}) {
      const SurfacePoint p = pointAt(wall.shape, uv);
      points.push_back({p.position, p.normal});                                       // on a wall
      points.push_back({glm::mix(p.position, Vec3(0.5, 0.75, 0.4), 0.4), p.normal});  // in the air
    }
  ProbeSettings settings;
  settings.error = 0.001, settings.maxSamples = 1 << 18;
  for (const ProbeResult& r : probe(engine.solution(), points, settings))
    EXPECT_NEAR(r.irradiance.g, exact, 0.005 * exact);
}
INSTANTIATE_TEST_SUITE_P(Reflectances, Furnace, testing::Values(0.1f, 0.5f, 0.9f),
                         [](const auto& instance) { return std::to_string(std::lround(100 * instance.param)); });

/// A room with a lamp below its ceiling and a block that casts shadows.
Scene room(float lamp) {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", Rgb(0.7f, 0.6f, 0.5f));
  test::addBox(scene, "room", white, {0, 0, 0}, {4, 3, 2.5}, true);
  test::addBox(scene, "block", white, {1.5, 1, 0}, {2.2, 1.8, 1.1}, false);
  const MaterialId light = test::addMaterial(scene, "light", Rgb(0.0f), Rgb(std::max(lamp, 1e-6f)));
  test::addPolygon(scene, "lamp", light, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  return scene;
}

std::vector<float> leafIrradiances(const Engine& engine) {
  std::vector<float> values;
  const Solution& s = engine.solution().get();
  forEachLeaf(s, [&](hierarchy::ElementId e) {
    const hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    values.push_back(l.direct.r + l.indirect.r);
  });
  return values;
}

TEST(Solve, IsLinearInTheLights) {
  // By a power of two: numbers of lines are rounded, and by others rounding differs.
  Engine once(room(10.0f)), more(room(40.0f));
  once.solve(), more.solve();
  const auto a = leafIrradiances(once), b = leafIrradiances(more);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(4 * a[i], b[i], 1e-3f * b[i] + 1e-5f);
}

}  // namespace
}  // namespace deltalux
