#pragma once
// From points of a scene to pixels of a view: the inverse of viewRay().
#include <deltalux/view.hpp>

namespace deltalux::rendering {

/// In pixels from the upper left corner, and the distance along the view's direction.
struct PixelPlace {
  float x = 0, y = 0, depth = 0;
};

class ViewProjection {
 public:
  ViewProjection() = default;
  ViewProjection(const View& view, int width, int height)
      : eye_(view.position),
        size_(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)),
        perspective_(view.kind == View::Kind::Perspective) {
    const Vec3 forward = glm::normalize(view.direction), right = glm::normalize(glm::cross(forward, view.up));
    const auto half = [&](double extent) { return perspective_ ? std::tan(glm::radians(extent) / 2) : extent / 2; };
    forward_ = Vec3f(forward);
    right_ = Vec3f(0.5 * width / half(view.horizontal) * right);
    down_ = Vec3f(-0.5 * height / half(view.vertical) * glm::cross(right, forward));
  }

  /// Of a point in front of the eye (depth > 0).
  PixelPlace operator()(const Vec3f& p) const {
    const Vec3f d = p - eye_;
    const float depth = glm::dot(d, forward_), scale = perspective_ ? 1 / depth : 1.0f;
    return {size_.x + scale * glm::dot(d, right_), size_.y + scale * glm::dot(d, down_), depth};
  }
  /// Of a direction: where what lies there at infinity is seen (perspective).
  PixelPlace ofDirection(const Vec3f& d) const { return (*this)(eye_ + d); }

 private:
  Vec3f eye_{0.0f}, forward_{0.0f, 0.0f, 1.0f}, right_{0.0f}, down_{0.0f};
  glm::vec2 size_{0.0f};
  bool perspective_ = true;
};

}  // namespace deltalux::rendering
