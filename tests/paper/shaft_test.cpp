#include "paper/shaft.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
using namespace paper;

namespace {

Vec3f randomPoint(Rng& rng, float size) {
  return {float(rng.uniform() - 0.5) * size, float(rng.uniform() - 0.5) * size, float(rng.uniform() - 0.5) * size};
}

hierarchy::ElementGeometry randomBox(Rng& rng) {
  hierarchy::ElementGeometry g;
  const Vec3f a = randomPoint(rng, 10), b = a + randomPoint(rng, 4);
  g.lower = glm::min(a, b), g.upper = glm::max(a, b);
  return g;
}

Vec3f inside(Rng& rng, const hierarchy::ElementGeometry& g) {
  return glm::mix(g.lower, g.upper, Vec3f(float(rng.uniform()), float(rng.uniform()), float(rng.uniform())));
}

TEST(Shaft, NeverMissesABoxOnALineBetweenTheEnds) {
  Rng rng(11);
  for (int k = 0; k < 20000; ++k) {
    const hierarchy::ElementGeometry a = randomBox(rng), b = randomBox(rng);
    const Vec3f p = glm::mix(inside(rng, a), inside(rng, b), float(rng.uniform()));
    const Vec3f half = glm::abs(randomPoint(rng, 0.2f)) + 1e-4f;
    EXPECT_TRUE(Shaft(a, b).meets(p - half, p + half));
  }
}

TEST(Shaft, IsTighterThanTheBoxOfBothEnds) {
  // Two small boxes at opposite corners: most of their common box lies outside the shaft.
  hierarchy::ElementGeometry a, b;
  a.lower = {0, 0, 0}, a.upper = {1, 1, 1}, b.lower = {9, 9, 9}, b.upper = {10, 10, 10};
  const Shaft shaft(a, b);
  EXPECT_FALSE(shaft.meets({8, 1, 1}, {9, 2, 2}));
  EXPECT_FALSE(shaft.meets({1, 8, 4}, {2, 9, 5}));
  EXPECT_TRUE(shaft.meets({5, 5, 5}, {5.1f, 5.1f, 5.1f}));
  Rng rng(5);
  int kept = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3f p = Vec3f(5.0f) + randomPoint(rng, 10);
    kept += shaft.meets(p - 0.01f, p + 0.01f);
  }
  EXPECT_LT(kept, 4000 / 10);
}

}  // namespace
}  // namespace deltalux
