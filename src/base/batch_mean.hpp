#pragma once
// The mean of independent estimates, and how well it is known.
#include <cmath>
#include <deltalux/units.hpp>

namespace deltalux {

/// Light that few estimates hold makes those known worse than their scatter says; so the one that is farthest off
/// counts once more. Of many estimates that scatter evenly this changes next to nothing.
class BatchMean {
 public:
  void add(const RgbSum& x) {
    sum_ += x, squares_ += x * x, ++count_;
    least_ = count_ > 1 ? glm::min(least_, x) : x, most_ = count_ > 1 ? glm::max(most_, x) : x;
  }
  int count() const { return count_; }
  RgbSum mean() const { return count_ > 0 ? sum_ / double(count_) : RgbSum(0.0); }
  /// Of the mean; 0 of fewer than two.
  RgbSum standardError() const {
    if (count_ < 2) return RgbSum(0.0);
    const double n = count_;
    const RgbSum m = mean(), off = glm::max(most_ - m, m - least_) / n;
    return glm::sqrt(glm::max(squares_ / n - m * m, RgbSum(0.0)) / (n - 1) + off * off);
  }

 private:
  RgbSum sum_{0.0}, squares_{0.0}, least_{0.0}, most_{0.0};
  int count_ = 0;
};

}  // namespace deltalux
