#include "render/sight.hpp"

#include <gtest/gtest.h>

#include "direct/room_with_window.hpp"
#include "render/reconstruction.hpp"

namespace deltalux {
using namespace rendering;

namespace {

struct Moments {
  double mean = 0, variance = 0;
};

Moments momentsOf(Sights& sights, hierarchy::ElementId leaf, const direct::Receiver& x, std::uint64_t key) {
  constexpr int kTimes = 4000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kTimes; ++i) {
    double E = 0;
    sights.sample(leaf, x, 4, 0, combineKeys(key, i),
                  [&](const direct::Arrival& a) { E += glm::dot(a.direction, x.normal) * gray(a.E); });
    sum += E, squares += E * E;
  }
  const double mean = sum / kTimes;
  return {mean, squares / kTimes - mean * mean};
}

class SightTest : public testing::Test {
 protected:
  /// A point of the wall that faces the window, and its leaf.
  std::pair<hierarchy::ElementId, direct::Receiver> place(double y, double z) const {
    const direct::Receiver x{{0, y, z}, {1, 0, 0}};
    const hierarchy::ElementId side = reconstruction_.locator.side(PrimitiveId(4), 0, true);
    EXPECT_TRUE(side.valid());
    return {reconstruction_.locator.locate(side, x.position).leaf, x};
  }

  Engine engine_ = test::solved(test::roomWithWindow(), 0.3);
  const Solution& solution_ = engine_.solution().get();
  Reconstruction reconstruction_{solution_};
  Sights learnt_{solution_.elements, reconstruction_.sources}, plain_{solution_.elements, reconstruction_.sources};
};

TEST_F(SightTest, LearningKeepsTheMeanAndAddsNoNoise) {
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      const auto [leaf, x] = place(1.6 + 0.05 * i, 0.4 + 0.05 * j);
      learnt_.note(leaf, x);
    }
  learnt_.learn(64, 4, 7);
  for (const double y : {1.63, 1.81, 1.92}) {
    const auto [leaf, x] = place(y, 0.57);
    const Moments a = momentsOf(plain_, leaf, x, 1), b = momentsOf(learnt_, leaf, x, 2);
    EXPECT_GT(b.mean, 0.0);
    EXPECT_NEAR(a.mean, b.mean, 5 * std::sqrt((a.variance + b.variance) / 4000)) << y;
    EXPECT_LT(b.variance, a.variance) << y;
  }
}

TEST_F(SightTest, WhatItDoesNotExpectIsStillFound) {
  // Learnt where the window is, used where the lamp alone is near: the mean is what an unlearnt sight has.
  const auto [leaf, x] = place(2.0, 0.5);
  for (int i = 0; i < 32; ++i) learnt_.note(leaf, x);
  learnt_.learn(64, 4, 7);
  const hierarchy::ElementGeometry& g = solution_.elements.shape(leaf);
  const direct::Receiver corner{Vec3(0.98 * Vec3(g.upper) + 0.02 * Vec3(g.lower)), {1, 0, 0}};
  const Moments a = momentsOf(plain_, leaf, corner, 1), b = momentsOf(learnt_, leaf, corner, 2);
  EXPECT_GT(a.mean, 0.0);
  EXPECT_NEAR(a.mean, b.mean, 5 * std::sqrt((a.variance + b.variance) / 4000));
}

}  // namespace
}  // namespace deltalux
