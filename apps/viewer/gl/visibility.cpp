#include "gl/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::viewer::gl {

namespace {
constexpr double kNearestShare = 1e-5;  // of the farthest depth: nearer things are cut, or 24 bits tell nothing apart

template <class Visit>
void forCorners(const Extent& e, const Visit& visit) {
  for (int i = 0; i < 8; ++i)
    visit(glm::vec3(i & 1 ? e.upper.x : e.lower.x, i & 2 ? e.upper.y : e.lower.y, i & 4 ? e.upper.z : e.lower.z));
}
}  // namespace

Extent moved(const Extent& e, const glm::mat4& m) {
  Extent result;
  result.lower = glm::vec3(std::numeric_limits<float>::infinity()), result.upper = -result.lower;
  forCorners(e, [&](const glm::vec3& p) {
    const glm::vec3 q(m * glm::vec4(p, 1.0f));
    result.lower = glm::min(result.lower, q), result.upper = glm::max(result.upper, q);
  });
  return result;
}

ScreenBox screenBox(const Extent& e, const glm::mat4& toClip, int width, int height) {
  const glm::vec2 size(width, height);
  ScreenBox box{size, glm::vec2(0.0f)};
  bool behind = false;
  forCorners(e, [&](const glm::vec3& p) {
    const glm::vec4 q = toClip * glm::vec4(p, 1.0f);
    behind = behind || !(q.w > 0);
    const glm::vec2 pixel = glm::clamp((glm::vec2(q) / q.w * 0.5f + 0.5f) * size, glm::vec2(0.0f), size);
    box.lower = glm::min(box.lower, pixel), box.upper = glm::max(box.upper, pixel);
  });
  return behind ? ScreenBox{glm::vec2(0.0f), size} : box;
}

Visibility::Visibility(const Eye& eye, const std::optional<Box>& section)
    : eye_(eye), section_(section), nearest_(kInfinity) {
  const glm::dmat4 rows = glm::transpose(toClip(eye, {1, 2}));  // its sides do not depend on the depths
  for (int i = 0; i < 4; ++i)
    planes_[static_cast<std::size_t>(i)] = glm::vec4(i % 2 ? rows[3] - rows[i / 2] : rows[3] + rows[i / 2]);
}

bool Visibility::sees(const Extent& e) const {
  if (e.flat()) {
    const double facing = eye_.parallel ? -glm::dot(glm::dvec3(e.normal), eye_.forward)
                                        : glm::dot(glm::dvec3(e.normal), eye_.position) - double(e.offset);
    if (!(facing > 0)) return false;
  }
  if (section_ && !section_->overlaps({Vec3(e.lower), Vec3(e.upper)})) return false;
  for (const glm::vec4& plane : planes_) {
    const glm::vec3 farthest = glm::mix(e.lower, e.upper, glm::greaterThan(glm::vec3(plane), glm::vec3(0.0f)));
    if (glm::dot(glm::vec3(plane), farthest) + plane.w < 0) return false;
  }
  return true;
}

double Visibility::distance(const Extent& e) const {
  return glm::distance(eye_.position, glm::clamp(eye_.position, Vec3(e.lower), Vec3(e.upper)));
}

void Visibility::include(const Extent& e) {
  forCorners(
      e, [&](const glm::vec3& p) { farthest_ = std::max(farthest_, glm::dot(Vec3(p) - eye_.position, eye_.forward)); });
  nearest_ = std::min(nearest_, distance(e));
}

DepthRange Visibility::depths() const {
  if (!(farthest_ > 0)) return {};
  const double farthest = farthest_ * 1.01;
  if (eye_.parallel) return {0, farthest};
  // A point at a distance is nearer along the view, most so in the corner of the picture.
  const double cosCorner = 1 / std::sqrt(1 + eye_.halfWidth * eye_.halfWidth + eye_.halfHeight * eye_.halfHeight);
  return {std::clamp(0.99 * cosCorner * nearest_, kNearestShare * farthest, 0.5 * farthest), farthest};
}

}  // namespace deltalux::viewer::gl
