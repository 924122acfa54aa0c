// What lines and shadow rays say of their own noise.
#include "render/leaf_irradiance.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace rendering;

namespace {

/// A closed room whose walls, and what stands in it, all shine and reflect alike: light is even, so that leaves differ
/// by chance alone.
TEST(LeafIrradiance, NoiseIsWhatLeavesVaryBy) {
  Scene scene;
  const MaterialId shining = test::addMaterial(scene, "shining", test::lambert(0.5f), Emission{Rgb(1.0f), true, {}});
  test::addBox(scene, shining, {0, 0, 0}, {4, 4, 3}, true);
  for (int i = 0; i < 9; ++i) {
    const Vec3 at(0.5 + 1.3 * (i % 3), 0.5 + 1.2 * (i / 3), 0.3 + 0.2 * i);
    test::addBox(scene, shining, at, at + Vec3(0.4, 0.3, 0.5), false);
  }
  Engine engine(std::move(scene), {.error = 0.02});
  engine.solve();
  const Solution& s = engine.solution().get();
  const std::vector<LeafIrradiance> values = meshIrradiance(s.elements, s.caustics, s.deviation);
  double area = 0, sum = 0, squares = 0, predicted = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!s.elements.isReceivingLeaf(hierarchy::ElementId(i)) || s.elements.geometry[i].exposed < 1 ||
        !s.elements.topology[i].front)
      continue;
    const double A = s.elements.geometry[i].area, E = gray(values[i].direct + values[i].indirect);
    area += A, sum += A * E, squares += A * E * E, predicted += A * values[i].noise * values[i].noise;
  }
  const double mean = sum / area, varies = std::sqrt(squares / area - mean * mean), noise = std::sqrt(predicted / area);
  EXPECT_GT(varies, 0.001 * mean);
  // Lines are stratified: they vary by less than as many independent ones.
  EXPECT_LT(varies, 1.2 * noise);
  EXPECT_GT(varies, 0.3 * noise);
}

}  // namespace
}  // namespace deltalux
