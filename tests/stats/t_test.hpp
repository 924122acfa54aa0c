#pragma once
// Is the mean of independent samples the expected value?
#include <cmath>
#include <cstdint>

#include "stats/distributions.hpp"

namespace deltalux::test {

/// Mean and variance without cancellation. [Welford62]
class Moments {
 public:
  void add(double x) {
    ++count_;
    const double d = x - mean_;
    mean_ += d / static_cast<double>(count_);
    squares_ += d * (x - mean_);
  }
  std::uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : 0.0; }
  double standardError() const { return std::sqrt(variance() / static_cast<double>(count_)); }

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// Two-sided p-value of the hypothesis that the samples' mean is `expected`.
inline double tTest(const Moments& samples, double expected) {
  const double difference = samples.mean() - expected;
  if (samples.standardError() == 0) return std::abs(difference) <= 1e-9 * std::abs(expected) ? 1.0 : 0.0;
  return studentTwoSidedTail(difference / samples.standardError(), static_cast<double>(samples.count() - 1));
}

}  // namespace deltalux::test
