#include "radiosity/space_change.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
namespace {

Vec3f point(Rng& rng, float size) {
  return size * (2.0f * Vec3f(Vec3(rng.uniform(), rng.uniform(), rng.uniform())) - Vec3f(1.0f));
}

Vec3f inBall(Rng& rng, const Vec3f& center, float radius) {
  for (;;)
    if (const Vec3f p = point(rng, 1.0f); glm::dot(p, p) <= 1) return center + radius * p;
}

SpaceChange twoBoxes(Rng& rng) {
  SpaceChange space;
  for (int i = 0; i < 2; ++i) {
    const Vec3f a = point(rng, 1.0f), b = a + 0.3f * glm::abs(point(rng, 1.0f));
    space.add(Box{Vec3(a), Vec3(b)});
  }
  return space;
}

bool mayMeet(const SpaceChange& space, const Vec3f& center, float radius, const Vec3f& d) {
  const DirectionCode code = directionCode(d);
  std::vector<std::uint32_t> out;
  ElementGeometry from;
  from.lower = center - radius, from.upper = center + radius;
  space.meetsRays(from, {&code, 1}, out);
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

/// Where a hull of balls or a beam is said to meet nothing, no ray in it does; and it is often said.
TEST(SpaceChange, HullsAndBeamsHoldTheirRays) {
  Rng rng(7);
  int hulls = 0, beams = 0, unseen = 0;
  for (int k = 0; k < 2000; ++k) {
    const SpaceChange space = twoBoxes(rng);
    const Vec3f a = point(rng, 2.0f), b = point(rng, 2.0f);
    const auto upTo = [&](double most) { return static_cast<float>(most * rng.uniform()); };
    const float ra = upTo(0.3), rb = upTo(0.3), angle = upTo(0.6);
    const Vec3f axis = glm::normalize(b - a);
    const bool hull = space.meets(a, ra, b, rb), beam = space.meetsBeam(a, ra, axis, angle);
    hulls += !hull, beams += !beam;
    for (int i = 0; i < 20; ++i) {
      const Vec3f p = inBall(rng, a, ra), q = inBall(rng, b, rb);
      const Vec3f d = inBall(rng, Vec3f(0.0f), 1.0f), across = glm::normalize(glm::cross(axis, d));
      const float off = upTo(angle);
      const bool far = space.meets(Ray{p, 0.0f, d, 1e30f}), near = mayMeet(space, a, ra, d);
      unseen += !near;
      EXPECT_TRUE(near || !far);
      EXPECT_FALSE(!hull && space.meets(Ray{p, 0.0f, q - p, 1.0f}));
      EXPECT_FALSE(!beam && space.meets(Ray{p, 0.0f, std::cos(off) * axis + std::sin(off) * across, 1e30f}));
    }
  }
  EXPECT_GT(hulls, 500);
  EXPECT_GT(beams, 500);
  EXPECT_GT(unseen, 20 * 500);
}

}  // namespace
}  // namespace deltalux
