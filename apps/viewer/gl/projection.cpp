#include "gl/projection.hpp"

#include <cmath>

namespace deltalux::viewer::gl {

Eye eyeOf(const View& v) {
  Eye eye;
  eye.position = v.position;
  eye.forward = glm::normalize(v.direction);
  eye.right = glm::normalize(glm::cross(eye.forward, v.up));
  eye.up = glm::cross(eye.right, eye.forward);
  eye.parallel = v.kind == View::Kind::Parallel;
  const auto half = [&](double angleOrWidth) {
    return eye.parallel ? angleOrWidth / 2 : std::tan(glm::radians(angleOrWidth) / 2);
  };
  eye.halfWidth = half(v.horizontal), eye.halfHeight = half(v.vertical);
  return eye;
}

glm::dmat4 toClip(const Eye& eye, const DepthRange& range) {
  const double n = range.nearest, f = range.farthest;
  const auto row = [&](const Vec3& axis) { return glm::dvec4(axis, -glm::dot(axis, eye.position)); };
  const glm::dvec4 x = row(eye.right) / eye.halfWidth, y = -row(eye.up) / eye.halfHeight, depth = row(eye.forward);
  const glm::dvec4 one(0, 0, 0, 1);
  if (eye.parallel) return glm::transpose(glm::dmat4(x, y, (2.0 * depth - (f + n) * one) / (f - n), one));
  return glm::transpose(glm::dmat4(x, y, ((f + n) * depth - 2.0 * f * n * one) / (f - n), depth));
}

}  // namespace deltalux::viewer::gl
