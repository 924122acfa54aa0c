#include "scene/form_factor.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.hpp"

namespace deltalux {
using namespace scene;

namespace {

TEST(FormFactor, PatchUnderTheCornerOfARectangle) {
  // Howell B-3: a small patch below one corner of an a x b rectangle at height c.
  const double a = 2, b = 3, c = 1.5, A = a / c, B = b / c;
  const double exact = (A / std::sqrt(1 + A * A) * std::atan(B / std::sqrt(1 + A * A)) +
                        B / std::sqrt(1 + B * B) * std::atan(A / std::sqrt(1 + B * B))) /
                       (2 * kPi);
  const std::vector<Vec3f> rectangle = {{0, 0, 1.5f}, {2, 0, 1.5f}, {2, 3, 1.5f}, {0, 3, 1.5f}};
  EXPECT_NEAR(formFactorToPolygon(Vec3f(0.0f), {0, 0, 1}, rectangle), exact, 1e-6);
}

TEST(FormFactor, ClosedBoxSumsToOneAndTheHorizonClips) {
  const std::vector<std::vector<Vec3f>> walls = {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                                                 {{-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}, {-1, -1, 1}},
                                                 {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
                                                 {{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}},
                                                 {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}};
  Rng rng(3);
  for (int k = 0; k < 200; ++k) {
    const Vec3f x(float(rng.uniform() * 1.9 - 0.95), float(rng.uniform() * 1.9 - 0.95), float(rng.uniform() - 0.6));
    double sum = 0;
    for (const auto& w : walls) sum += formFactorToPolygon(x, {0, 0, 1}, w);
    EXPECT_NEAR(sum, 1.0, 1e-4);
  }
}

TEST(FormFactor, OfASmallPolygonFarAwayIsThatOfItsArea) {
  const std::vector<Vec3f> lamp = {
      {-0.01f, -0.01f, 0.5f}, {-0.01f, 0.01f, 0.5f}, {0.01f, 0.01f, 0.5f}, {0.01f, -0.01f, 0.5f}};
  for (const double r : {1.0, 10.0, 100.0, 1000.0}) {
    const double squared = r * r + 0.25;
    EXPECT_NEAR(formFactorToPolygon(Vec3f(Vec3(r, 0, 0)), {0, 0, 1}, lamp) / (4e-4 * 0.25 / (kPi * squared * squared)),
                1, 2e-3);
  }
}

TEST(FormFactor, SeamsOfAHoleCancel) {
  // A square with a square hole, as one seamed outline, equals the square less the hole.
  const std::vector<Vec3f> seamed = {{-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}, {-2, -2, 1},
                                     {-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};
  const std::vector<Vec3f> outer = {{-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}};
  const std::vector<Vec3f> hole = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  const Vec3f x(0.3f, -0.2f, 0.0f), n(0, 0, 1);
  EXPECT_NEAR(formFactorToPolygon(x, n, seamed), formFactorToPolygon(x, n, outer) - formFactorToPolygon(x, n, hole),
              1e-6);
}

}  // namespace
}  // namespace deltalux
