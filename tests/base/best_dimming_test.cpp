// Least squares within bounds: against closed forms, the optimum's conditions, and a search by brute force.
#include <gtest/gtest.h>

#include <deltalux/design.hpp>

#include "base/random.hpp"

namespace deltalux {
namespace {

using Matrix = std::vector<std::vector<double>>;

double misses(const Matrix& brings, const std::vector<double>& targets, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t p = 0; p < targets.size(); ++p) {
    double reached = 0;
    for (std::size_t g = 0; g < brings.size(); ++g) reached += weights[g] * brings[g][p];
    sum += (reached - targets[p]) * (reached - targets[p]);
  }
  return sum;
}

TEST(BestDimming, FindsWhatTheTargetsWereMadeOf) {
  const Matrix brings{{100, 20, 5, 1}, {10, 150, 30, 2}, {3, 15, 90, 40}};
  const std::vector<double> made{0.25, 0.9, 0.6};
  std::vector<double> targets(4, 0.0);
  for (std::size_t g = 0; g < 3; ++g)
    for (std::size_t p = 0; p < 4; ++p) targets[p] += made[g] * brings[g][p];
  const Dimmed dimmed = bestDimming(brings, targets);
  for (std::size_t g = 0; g < 3; ++g) EXPECT_NEAR(dimmed.weights[g], made[g], 1e-9);
  for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(dimmed.reached[p], targets[p], 1e-7);
}

TEST(BestDimming, KeepsToItsBounds) {
  const Dimmed much = bestDimming({{100, 100}}, {300, 500});
  EXPECT_EQ(much.weights[0], 1);
  EXPECT_EQ(much.reached[1], 100);
  const Dimmed none = bestDimming({{100, 100}, {50, 0}}, {0, -20});
  EXPECT_EQ(none.weights, (std::vector<double>{0, 0}));
}

TEST(BestDimming, TakesGroupsThatBringNothingOrTheSame) {
  const Dimmed dimmed = bestDimming({{0, 0}, {80, 40}, {80, 40}}, {40, 20});
  EXPECT_NEAR(dimmed.reached[0], 40, 1e-6);
  EXPECT_NEAR(dimmed.reached[1], 20, 1e-6);
  EXPECT_EQ(dimmed.weights[0], 0);
}

TEST(BestDimming, NothingWithinTheBoundsIsBetter) {
  Rng random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t groups = 1 + static_cast<std::size_t>(6 * random.uniform()), points = 10;
    Matrix brings(groups, std::vector<double>(points));
    std::vector<double> targets(points);
    for (auto& group : brings)
      for (double& value : group) value = 300 * random.uniform() * random.uniform();
    for (double& target : targets) target = 500 * random.uniform();
    const Dimmed dimmed = bestDimming(brings, targets);
    const double least = misses(brings, targets, dimmed.weights);
    // Convex: it is best when no weight alone, moved a little within its bounds, makes it better.
    for (std::size_t g = 0; g < groups; ++g) {
      EXPECT_GE(dimmed.weights[g], 0);
      EXPECT_LE(dimmed.weights[g], 1);
      for (const double by : {-1e-4, 1e-4}) {
        std::vector<double> other = dimmed.weights;
        other[g] = std::clamp(other[g] + by, 0.0, 1.0);
        EXPECT_GE(misses(brings, targets, other), least * (1 - 1e-12)) << trial;
      }
    }
  }
}

}  // namespace
}  // namespace deltalux
