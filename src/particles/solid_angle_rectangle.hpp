#pragma once
// Points of a rectangle uniform in the solid angle under which another point sees it: a sender next to a mirror or a
// floor then has bounded weights, however close it is.
// [UFK13]
#include <algorithm>
#include <deltalux/math.hpp>

#include "base/unit_circle.hpp"

namespace deltalux::particles {

/// A rectangle: corner, unit edge directions at right angles, lengths.
struct Rectangle {
  Vec3 corner{0}, a{1, 0, 0}, b{0, 1, 0};
  double lengthA = 0, lengthB = 0;

  Vec3 normal() const { return glm::cross(a, b); }
  double area() const { return lengthA * lengthB; }
  Vec3 at(const Vec2& s) const { return corner + s.x * lengthA * a + s.y * lengthB * b; }
};

class SolidAngleRectangle {
 public:
  /// `from` does not lie in the rectangle's plane.
  SolidAngleRectangle(const Rectangle& r, const Vec3& from) : lengths_(r.lengthA, r.lengthB) {
    const Vec3 d = r.corner - from;
    z_ = -std::abs(glm::dot(d, r.normal()));
    x0_ = glm::dot(d, r.a), y0_ = glm::dot(d, r.b);
    x1_ = x0_ + r.lengthA, y1_ = y0_ + r.lengthB;
    // The planes through the point and an edge; only these components of their normals matter.
    const auto slope = [&](double at) { return at / std::sqrt(at * at + z_ * z_); };
    b0_ = -slope(y0_), b1_ = slope(y1_);
    const double n1 = slope(x1_), n3 = -slope(x0_);
    const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    k_ = 2 * kPi - angle(-b1_ * n3) - angle(-n3 * b0_);  // [UFK13 (5)]
    omega_ = angle(-b0_ * n1) + angle(-n1 * b1_) - k_;
  }

  double solidAngle() const { return omega_; }

  /// Where on the rectangle, as shares of its edges.
  Vec2 sample(const Vec2& u) const {
    const Vec2 phi = onUnitCircle((u.x * omega_ + k_) / (2 * kPi));
    const double f = (phi.x * b0_ - b1_) / phi.y;
    const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
    const double x = std::clamp(-c * z_ / std::max(std::sqrt(1 - c * c), 1e-12), x0_, x1_);
    const double d2 = x * x + z_ * z_;
    const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const double h = h0 + u.y * (h1 - h0);
    const double y = h * h < 1 - 1e-12 ? std::clamp(h * std::sqrt(d2 / (1 - h * h)), y0_, y1_) : y1_;
    return {(x - x0_) / lengths_.x, (y - y0_) / lengths_.y};
  }

 private:
  Vec2 lengths_;
  double x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, z_ = 0, b0_ = 0, b1_ = 0, k_ = 0, omega_ = 0;
};

}  // namespace deltalux::particles
