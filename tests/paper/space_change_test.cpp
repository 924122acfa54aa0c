#include "paper/space_change.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
using namespace paper;

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

/// Where a hull of balls or a beam is said to meet nothing, no ray in it does; and it is often said.
TEST(SpaceChange, HullsAndBeamsHoldTheirRays) {
  Rng rng(7);
  int hulls = 0, boxBeams = 0, outside = 0;
  for (int k = 0; k < 2000; ++k) {
    const SpaceChange space = boxes(rng, 2);
    const Vec3f a = point(rng, 2.0f), b = point(rng, 2.0f);
    const auto upTo = [&](double most) { return static_cast<float>(most * rng.uniform()); };
    const float ra = upTo(0.3), rb = upTo(0.3), angle = upTo(0.6);
    const Vec3f axis = glm::normalize(b - a);
    const bool hull = space.meets(a, ra, b, rb), boxBeam = space.meetsBeam(boxAround(a, ra), axis, angle);
    Vec3 middle;
    const auto seen = space.seenFrom(a, ra, middle);
    hulls += !hull, boxBeams += !boxBeam;
    for (int i = 0; i < 20; ++i) {
      const Vec3f p = inBall(rng, a, ra), q = inBall(rng, b, rb);
      const Vec3f d = inBall(rng, Vec3f(0.0f), 1.0f), across = glm::normalize(glm::cross(axis, d));
      const float off = upTo(angle);
      EXPECT_FALSE(!hull && space.meets(tracing::Ray{p, 0.0f, q - p, 1.0f}));
      const Vec3f w = std::cos(off) * axis + std::sin(off) * across;
      EXPECT_FALSE(!boxBeam && space.meets(tracing::Ray{a + point(rng, ra), 0.0f, w, 1e30f}));
      const bool within = !seen || glm::dot(Vec3(w), middle) > std::cos(*seen) - 1e-5;
      outside += !within;
      EXPECT_TRUE(within || !space.meets(tracing::Ray{p, 0.0f, w, 1e30f}));
    }
  }
  EXPECT_GT(hulls, 500);
  EXPECT_GT(boxBeams, 500);
  EXPECT_GT(outside, 20 * 500);
}

}  // namespace
}  // namespace deltalux
