#include "base/batch_mean.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
namespace {

TEST(BatchMean, OfEvenScatterIsTheUsualStandardError) {
  BatchMean mean;
  Rng rng(3);
  for (int i = 0; i < 400; ++i) mean.add(RgbSum(rng.uniform()));
  EXPECT_NEAR(mean.mean().g, 0.5, 0.05);
  EXPECT_NEAR(mean.standardError().g, std::sqrt(1.0 / 12 / 400), 0.05 * std::sqrt(1.0 / 12 / 400));
}

TEST(BatchMean, OfOneBrightEstimateAmongDarkOnesIsHardlyKnown) {
  BatchMean mean;
  mean.add(RgbSum(32.0));
  for (int i = 1; i < 32; ++i) mean.add(RgbSum(0.0));
  EXPECT_GT(mean.standardError().r, 1.3);  // 1 by scatter alone
}

TEST(BatchMean, OfOneIsNotKnown) {
  BatchMean mean;
  EXPECT_EQ(mean.mean().r, 0.0);
  mean.add(RgbSum(2.0));
  EXPECT_EQ(mean.mean().r, 2.0);
  EXPECT_EQ(mean.standardError().r, 0.0);
}

}  // namespace
}  // namespace deltalux
