// Passages through a ball obey Snell's law on both sides, few are missed, and they spread as neighbouring rays do.
#include "render/reference/refracting_ball.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "render/reference/light_connections.hpp"

namespace deltalux {
using namespace rendering;

namespace {

constexpr double kIor = 1.5;
const Sphere kBall{{0.2, 0.1, -0.3}, 0.7};

Vec3 randomDirection(Rng& rng) {
  const double z = 1 - 2 * rng.uniform(), r = std::sqrt(1 - z * z), phi = 2 * kPi * rng.uniform();
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec3 refract(const Vec3& d, const Vec3& n, double eta) {  // n against d, eta = n before / n behind
  const double c = -glm::dot(d, n);
  return eta * d + (eta * c - std::sqrt(1 - eta * eta * (1 - c * c))) * n;
}

/// Where a ray from x along d goes: exit point and direction, by Snell's law in three dimensions.
std::optional<std::pair<Vec3, Vec3>> trace(const Vec3& x, const Vec3& d, int inner) {
  const Vec3 o = x - kBall.center;
  const double b = -glm::dot(o, d), q = kBall.radius * kBall.radius - glm::dot(o, o) + b * b;
  if (b < 0 || q < 0) return std::nullopt;
  const Vec3 entry = x + (b - std::sqrt(q)) * d, n = (entry - kBall.center) / kBall.radius;
  Vec3 in = refract(d, n, 1 / kIor);
  Vec3 exit = entry - 2 * glm::dot(entry - kBall.center, in) * in;
  for (int k = 0; k < inner; ++k) {
    const Vec3 out = (exit - kBall.center) / kBall.radius;
    in -= 2 * glm::dot(in, out) * out;
    exit -= 2 * glm::dot(exit - kBall.center, in) * in;
  }
  return std::pair(exit, refract(in, -(exit - kBall.center) / kBall.radius, kIor));
}

TEST(RefractingBall, PassagesAreRealAndFewAreMissed) {
  Rng rng(3);
  for (int inner = 0; inner <= rendering::kMostInner; ++inner) {
    int rays = 0, missed = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 x = kBall.center + (0.71 + 2 * rng.uniform()) * randomDirection(rng);
      const Vec3 d = glm::normalize(kBall.center + kBall.radius * randomDirection(rng) - x);
      const auto way = trace(x, d, inner);
      if (!way) continue;
      const auto [exit, direction] = *way;
      const bool infinite = i % 2 == 0;
      const LightPlace light{infinite ? direction : exit + 2 * rng.uniform() * direction, infinite};
      const BallPassages passages = ballPassages(kBall, kIor, inner, x, light);
      bool found = false;
      for (int k = 0; k < passages.count; ++k) {
        const BallPassage& p = passages.list[k];
        const auto check = trace(x, glm::normalize(p.entry - x), inner);
        ASSERT_TRUE(check);
        EXPECT_LT(glm::length(check->first - p.exit), 1e-5);
        EXPECT_LT(glm::length(check->second - p.direction), 1e-5);
        const Vec3 aim = infinite ? light.at : glm::normalize(light.at - p.exit);
        if (infinite || glm::length(light.at - p.exit) > 0.01) {
          EXPECT_LT(glm::length(aim - p.direction), 1e-4);
        }
        found |= glm::length(p.exit - exit) < 1e-4;
      }
      ++rays, missed += !found;
    }
    EXPECT_GT(rays, 5000);
    EXPECT_LT(missed, rays / 200) << inner;
  }
}

TEST(RefractingBall, SpreadIsThatOfNeighbouringRays) {
  Rng rng(5);
  for (int i = 0; i < 800; ++i) {
    const int inner = i % 4;
    const Vec3 x = kBall.center + (0.75 + 2 * rng.uniform()) * randomDirection(rng);
    const Vec3 d = glm::normalize(kBall.center + 0.6 * randomDirection(rng) - x);
    const double after = 0.1 + 2 * rng.uniform(), h = 1e-6;
    const Frame frame(d);
    const Vec3 d1 = glm::normalize(d + h * frame.tangent), d2 = glm::normalize(d + h * frame.bitangent);
    const auto w0 = trace(x, d, inner), w1 = trace(x, d1, inner), w2 = trace(x, d2, inner);
    if (!w0 || !w1 || !w2) continue;
    const auto entry = [&] {
      const Vec3 o = x - kBall.center;
      const double b = -glm::dot(o, d);
      return x + (b - std::sqrt(kBall.radius * kBall.radius - glm::dot(o, o) + b * b)) * d;
    }();
    const BallPassage p = passageFrom(kBall, kIor, inner, x, entry);
    EXPECT_LT(glm::length(p.exit - w0->first), 1e-9);
    const Vec3 plane = w0->first + after * w0->second;
    const auto onPlane = [&](const std::pair<Vec3, Vec3>& w) {
      return w.first + glm::dot(plane - w.first, w0->second) / glm::dot(w.second, w0->second) * w.second;
    };
    const double area =
        std::abs(glm::dot(glm::cross(onPlane(*w1) - plane, onPlane(*w2) - plane), w0->second)) / (h * h);
    const double angles = glm::length(glm::cross(w1->second - w0->second, w2->second - w0->second)) / (h * h);
    EXPECT_NEAR(passageSpread(kBall, kIor, inner, x, p, after), area, 1e-3 * std::max(area, 1.0));
    EXPECT_NEAR(passageSpread(kBall, kIor, inner, x, p, kInfinity), angles, 1e-3 * std::max(angles, 1.0));
  }
}

}  // namespace
}  // namespace deltalux
