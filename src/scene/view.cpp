#include <algorithm>
#include <deltalux/view.hpp>

#include "base/check.hpp"

namespace deltalux {

namespace {

/// Half extents of the picture: at unit distance (perspective) or in scene units (parallel).
Vec2 halfExtent(const View& view) {
  if (view.kind == View::Kind::Parallel) return {view.horizontal / 2, view.vertical / 2};
  return {std::tan(glm::radians(view.horizontal) / 2), std::tan(glm::radians(view.vertical) / 2)};
}

}  // namespace

ViewRay viewRay(const View& view, double x, double y) {
  const Vec3 forward = glm::normalize(view.direction);
  const Vec3 sideways = glm::cross(forward, view.up);
  DELTALUX_CHECK(glm::length(sideways) > 0, "the view's up vector is parallel to its direction");
  const Vec3 right = glm::normalize(sideways);
  const Vec3 upward = glm::cross(right, forward);
  const Vec2 half = halfExtent(view);
  const Vec3 offset = (2 * x - 1) * half.x * right + (1 - 2 * y) * half.y * upward;
  if (view.kind == View::Kind::Parallel) return {view.position + offset, forward};
  return {view.position, glm::normalize(forward + offset)};
}

glm::ivec2 fitResolution(const View& view, int maxWidth, int maxHeight) {
  DELTALUX_CHECK(maxWidth > 0 && maxHeight > 0, "the picture needs pixels");
  const Vec2 half = halfExtent(view);
  const double aspect = half.x / half.y;
  const int width = std::min(maxWidth, static_cast<int>(std::lround(maxHeight * aspect)));
  const int height = std::min(maxHeight, static_cast<int>(std::lround(maxWidth / aspect)));
  return {std::max(width, 1), std::max(height, 1)};
}

}  // namespace deltalux
