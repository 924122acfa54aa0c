#pragma once
// Weighted least squares for the slope of a function at a point, from differences to points around it. Directions in
// which those points hardly spread get no slope, so a fit from few points is never wild.
#include <array>
#include <cmath>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>

#include "base/tuning.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

class LinearFit {
 public:
  /// Slopes within the plane of `normal` (unit); a zero normal has no slopes at all.
  explicit LinearFit(const Vec3f& normal) : flat_(glm::dot(normal, normal) > 0.5f) {
    if (!flat_) return;
    const Frame frame{Vec3(glm::normalize(normal))};
    t_ = frame.tangent, b_ = frame.bitangent;
  }

  /// A point at `offset`, where the function differs by `difference`. Near points count more, by 1 / distance^2: in
  /// space, so that one behind the point, on a ball, says nothing of slopes.
  void add(const Vec3f& offset, const Rgb& difference) {
    const Vec3 d(offset);
    const double x = glm::dot(d, t_), y = glm::dot(d, b_), squared = glm::dot(d, d);
    if (!flat_ || !(squared > 0)) return;
    const double w = 1.0 / squared;
    xx_ += w * x * x, xy_ += w * x * y, yy_ += w * y * y;
    x_ += w * x * RgbSum(difference), y_ += w * y * RgbSum(difference);
  }

  /// Slopes along the world's x, y and z, per unit of length.
  void slopes(std::array<Rgb, 3>& result) const {
    for (Rgb& r : result) r = Rgb(0.0f);
    const double half = 0.5 * (xx_ + yy_);
    if (!flat_ || !(half > 0)) return;
    // Eigenvalues of the symmetric 2 x 2 matrix of spreads, and the eigenvector (c, s) of the larger.
    const double apart = std::hypot(0.5 * (xx_ - yy_), xy_);
    const double large = half + apart, small = half - apart;
    const double angle = 0.5 * std::atan2(xy_, 0.5 * (xx_ - yy_));
    const double c = std::cos(angle), s = std::sin(angle);
    const RgbSum along = (c * x_ + s * y_) / large;
    const RgbSum across =
        small > double(deltalux::tuning::kNegligible) * large ? (c * y_ - s * x_) / small : RgbSum(0.0);
    const RgbSum gx = c * along - s * across, gy = s * along + c * across;
    for (int i = 0; i < 3; ++i) result[static_cast<std::size_t>(i)] = Rgb(t_[i] * gx + b_[i] * gy);
  }

 private:
  bool flat_;
  Vec3 t_{0}, b_{0};
  double xx_ = 0, xy_ = 0, yy_ = 0;
  RgbSum x_{0.0}, y_{0.0};
};

}  // namespace deltalux::rendering
