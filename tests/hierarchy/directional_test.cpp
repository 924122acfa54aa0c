#include "hierarchy/directional.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
namespace {

Vec3f randomDirection(Rng& rng) {
  const double z = 1 - 2 * rng.uniform(), phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
  return {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
}

TEST(Directional, BasisIsOrthonormal) {
  Rng rng(2);
  constexpr int n = 200000;
  double products[hierarchy::kHarmonics][hierarchy::kHarmonics] = {};
  for (int k = 0; k < n; ++k) {
    const auto y = hierarchy::harmonics(randomDirection(rng));
    for (int i = 0; i < hierarchy::kHarmonics; ++i)
      for (int j = 0; j < hierarchy::kHarmonics; ++j) products[i][j] += 4 * kPi / n * y[i] * y[j];
  }
  for (int i = 0; i < hierarchy::kHarmonics; ++i)
    for (int j = 0; j < hierarchy::kHarmonics; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 0.03);
}

TEST(Directional, OneLobeStaysNearTheClampedCosine) {
  Rng rng(4);
  for (int k = 0; k < 2000; ++k) {
    const Vec3f n = randomDirection(rng), w = randomDirection(rng);
    hierarchy::DirectionalRgb f;
    f.addLobe(n, Rgb(1.0f));
    EXPECT_NEAR(f.at(w).r, std::max(0.0f, glm::dot(n, w)), 0.095);  // 3/32 where it is worst, at 90 degrees
  }
}

TEST(Directional, ABoxOfLobesSendsItsMeanProjectedArea) {
  // Six unit faces of radiosity pi. Order 2 cannot tell a cube from a ball: a quarter of the surface everywhere
  // [Cauchy].
  hierarchy::DirectionalRgb f;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f n(0.0f);
      n[axis] = sign;
      f.addLobe(n, Rgb(1.0f));
    }
  Rng rng(6);
  for (int k = 0; k < 500; ++k) EXPECT_NEAR(f.at(randomDirection(rng)).g, 1.5, 1e-4);
}

}  // namespace
}  // namespace deltalux
