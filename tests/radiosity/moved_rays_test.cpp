#include "radiosity/moved_rays.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
using namespace paper;
using namespace radiosity;

namespace {

Vec3f point(Rng& rng, float size) {
  return size * (2.0f * Vec3f(Vec3(rng.uniform(), rng.uniform(), rng.uniform())) - Vec3f(1.0f));
}

Vec3f inBall(Rng& rng, const Vec3f& center, float radius) {
  for (;;)
    if (const Vec3f p = point(rng, 1.0f); glm::dot(p, p) <= 1) return center + radius * p;
}

SpaceChange boxes(Rng& rng, int count) {
  SpaceChange space;
  for (int i = 0; i < count; ++i) {
    const Vec3f a = point(rng, 1.0f), b = a + 0.3f * glm::abs(point(rng, 1.0f));
    space.add(Box{Vec3(a), Vec3(b)});
  }
  return space;
}

hierarchy::ElementGeometry boxAround(const Vec3f& center, float radius) {
  hierarchy::ElementGeometry g;
  g.lower = center - radius, g.upper = center + radius;
  return g;
}

bool mayMeet(const SpaceChange& space, const Vec3f& center, float radius, const RayCode& code) {
  std::vector<std::uint32_t> out;
  meetsRays(space, boxAround(center, radius), {&code, 1}, out);
  return !out.empty();
}

TEST(DirectionCode, IsCloseToItsDirection) {
  Rng rng(3);
  double furthest = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 d = glm::normalize(Vec3(inBall(rng, Vec3f(0.0f), 1.0f)));
    furthest = std::max(furthest, glm::length(glm::cross(d, glm::normalize(Vec3(direction(directionCode(Vec3f(d))))))));
    EXPECT_GT(glm::dot(d, Vec3(direction(directionCode(Vec3f(d))))), 0);
  }
  EXPECT_LT(furthest, kDirectionCodeError);
  EXPECT_GT(furthest, 0.3 * kDirectionCodeError);
}

/// A ray is met by what is on its way, however its direction is coded.
TEST(MovedRays, CodesHoldTheirRays) {
  Rng rng(7);
  int unseen = 0;
  for (int k = 0; k < 2000; ++k) {
    const SpaceChange space = boxes(rng, 2);
    const Vec3f a = point(rng, 2.0f);
    const float ra = static_cast<float>(0.3 * rng.uniform());
    for (int i = 0; i < 20; ++i) {
      const Vec3f p = inBall(rng, a, ra), d = inBall(rng, Vec3f(0.0f), 1.0f);
      const bool far = space.meets(tracing::Ray{p, 0.0f, d, 1e30f}),
                 near = mayMeet(space, a, ra, rayCode(directionCode(d), 1e30f, false));
      unseen += !near;
      EXPECT_TRUE(near || !far);
    }
  }
  EXPECT_GT(unseen, 20 * 500);
}

/// A ray with an end is met only up to it, one that is blocked only where it is; a row's reach holds its rays.
TEST(MovedRays, CodesAndReachHoldRaysWithEnds) {
  Rng rng(11);
  int unmet = 0, apart = 0, unreached = 0;
  for (int k = 0; k < 4000; ++k) {
    const SpaceChange space = boxes(rng, 1);
    const Vec3f a = point(rng, 2.0f);
    const float radius = static_cast<float>(0.2 * rng.uniform());
    const hierarchy::ElementGeometry leaf = boxAround(a, radius);
    RowReach reach;
    bool any = false;
    for (int i = 0; i < 4; ++i) {
      const Vec3f from = a + point(rng, radius), to = point(rng, 2.0f);
      const float seen = static_cast<float>(0.1 + 0.8 * rng.uniform());
      const Vec3f hit = from + seen * (to - from);
      const bool meets = space.meets(tracing::Ray{from, 0.0f, to - from, 1.0f}), there = space.meets(hit, hit);
      const bool open = mayMeet(space, a, radius, rayCode(to - a, false));
      const bool blocked = mayMeet(space, a, radius, rayCode(seen * (to - a), true));
      EXPECT_TRUE(open || !meets);
      EXPECT_TRUE(blocked || !there);
      EXPECT_TRUE(open || !blocked);
      unmet += !open, apart += open && !blocked;
      reach.add(leaf, to), any |= meets;
    }
    Vec3f lower = leaf.lower, upper = leaf.upper;
    reach.extend(leaf, lower, upper);
    EXPECT_TRUE(!any || space.meets(lower, upper));
    const bool reached = meets(space, leaf, reach);
    EXPECT_TRUE(reached || !any);
    unreached += !reached;
  }
  EXPECT_GT(unmet, 4000);
  EXPECT_GT(apart, 300);
  EXPECT_GT(unreached, 1000);
}

}  // namespace
}  // namespace deltalux
