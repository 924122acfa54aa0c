// What lies on a surface is told the same whatever else there is in the scene.
#include "lines/cover.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

/// Two squares side by side, and a dozen more that have nothing to do with them.
struct Paving {
  Scene alone, beside;
  Vec3f edge{0.0f};  // a point between the two

  explicit Paving(Rng& random) {
    const double y = 10 + 40 * random.uniform();
    const MaterialId m = addMaterial(alone, "stone", lambert(0.5f));
    addPolygon(alone, m, {{0, y - 0.3, 0}, {1, y - 0.3, 0}, {1, y, 0}, {0, y, 0}});
    addPolygon(alone, m, {{0, y, 0}, {1, y, 0}, {1, y + 0.3, 0}, {0, y + 0.3, 0}});
    beside = alone;
    for (int i = 1; i <= 12; ++i) {
      const double x = 1.5 * i, from = y - 1 + 2 * random.uniform();
      addPolygon(beside, m, {{x, from, 0}, {x + 1, from, 0}, {x + 1, from + 0.3, 0}, {x, from + 0.3, 0}});
    }
    edge = {0.37f, static_cast<float>(y), 0};
  }
};

bool covered(const Scene& scene, const Vec3f& p, PrimitiveId own) {
  const auto tracer = tracing::makeEmbreeTracer(scene);
  std::uint64_t rays = 0;
  return lines::Cover(scene, *tracer).covers(p, {0, 0, 1}, own, {0, 1}, rays);
}

TEST(Cover, OfAPointOnAnEdgeIsTheSameWhateverElseThereIs) {
  Rng random(1);
  int other = 0, covers = 0;
  for (int round = 0; round < 300; ++round) {
    const Paving paving(random);
    for (const PrimitiveId own : {PrimitiveId(0), PrimitiveId(1)}) {
      const bool is = covered(paving.alone, paving.edge, own);
      covers += is, other += is != covered(paving.beside, paving.edge, own);
    }
  }
  EXPECT_EQ(other, 0);
  EXPECT_GT(covers, 100);  // by the one beside
}

TEST(Cover, IsWhatLiesOnASurfaceWithinRoundings) {
  Scene scene;
  const MaterialId m = addMaterial(scene, "wood", lambert(0.5f));
  addPolygon(scene, m, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  addPolygon(scene, m, {{1, 1, 1e-6}, {2, 1, 1e-6}, {2, 2, 1e-6}, {1, 2, 1e-6}});
  EXPECT_TRUE(covered(scene, {1.5f, 1.5f, 0}, PrimitiveId(0)));
  EXPECT_FALSE(covered(scene, {2.5f, 1.5f, 0}, PrimitiveId(0)));
  EXPECT_FALSE(covered(scene, {1.5f, 1.5f, 1e-6f}, PrimitiveId(1)));
}

}  // namespace
}  // namespace deltalux
