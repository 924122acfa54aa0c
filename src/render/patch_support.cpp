#include "render/patch_support.hpp"

#include <algorithm>

namespace deltalux::rendering {

namespace {

/// The rectangle of parameters that the patch fills: of a flat one, what its outline leaves of its domain.
struct Rectangle {
  Vec2 lower, upper;
};

Rectangle rectangleOf(const hierarchy::Elements& elements, hierarchy::ElementId leaf) {
  const hierarchy::PatchDomain& d = elements.domain[leaf.index()];
  if (!elements.at(leaf).flat) return {{d.u0, d.v0}, {d.u1, d.v1}};
  Rectangle r{Vec2(kInfinity), Vec2(-kInfinity)};
  for (const Vec2& q : elements.outline(leaf)) r.lower = glm::min(r.lower, q), r.upper = glm::max(r.upper, q);
  return r;
}

}  // namespace

float relativeRadius(const Shape& shape, double v) {
  if (std::holds_alternative<Sphere>(shape)) return static_cast<float>(std::sqrt(std::max(0.0, 4 * v * (1 - v))));
  if (const auto* cone = std::get_if<Cone>(&shape))
    return static_cast<float>(cone->radius0 + v * (cone->radius1 - cone->radius0));
  if (const auto* ring = std::get_if<Ring>(&shape))
    return static_cast<float>(
        std::sqrt(glm::mix(ring->innerRadius * ring->innerRadius, ring->outerRadius * ring->outerRadius, v)));
  return 1.0f;
}

PatchSupport::PatchSupport(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId leaf)
    : kind_(elements.hasFaces(leaf)  ? Kind::Faces
            : elements.at(leaf).flat ? Kind::Flat
                                     : Kind::Round) {
  if (kind_ == Kind::Faces) {
    const hierarchy::ElementGeometry& g = elements.shape(leaf);
    origin_ = g.center;
    dualU_.x = 1 / std::max(kFacesSize * g.radius, 1e-30f);
    return;
  }
  const Rectangle r = rectangleOf(elements, leaf);
  const Vec2 center = 0.5 * (r.lower + r.upper), half = glm::max(0.5 * (r.upper - r.lower), Vec2(1e-12));
  const hierarchy::PatchDomain& d = elements.domain[leaf.index()];
  if (flat()) {
    const hierarchy::PlaneFrame& f = elements.frames[d.frame];
    const Vec3 n = glm::cross(f.edgeU, f.edgeV);
    const double squared = std::max(glm::dot(n, n), 1e-300);
    origin_ = Vec3f(f.at(center));
    dualU_ = Vec3f(glm::cross(f.edgeV, n) / (squared * half.x));
    dualV_ = Vec3f(glm::cross(n, f.edgeU) / (squared * half.y));
    return;
  }
  const Shape& shape = scene[d.primitive].shape;
  const double radius =
      std::max({double(relativeRadius(shape, center.y)),
                0.5 * double(relativeRadius(shape, r.lower.y) + relativeRadius(shape, r.upper.y)), 1e-12});
  origin_ = {static_cast<float>(center.x), static_cast<float>(center.y), 0.0f};
  dualU_.x = static_cast<float>(1.0 / (radius * half.x));
  dualV_.x = static_cast<float>(1.0 / half.y);
}

bool PatchSupport::reaches(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId leaf) const {
  glm::vec2 lower(std::numeric_limits<float>::infinity()), upper(-lower);
  if (kind_ == Kind::Faces) {
    const hierarchy::ElementGeometry& g = elements.shape(leaf);
    return (glm::length(g.center - origin_) - g.radius) * dualU_.x < kReach;
  }
  if (flat() && elements.hasFaces(leaf)) return true;  // its box was near
  if (flat()) {
    const hierarchy::PlaneFrame& f = elements.frames[elements.domain[leaf.index()].frame];
    for (const Vec2& q : elements.outline(leaf)) {
      SupportPoint p;
      p.position = Vec3f(f.at(q));
      const glm::vec2 t = coordinates(p);
      lower = glm::min(lower, t), upper = glm::max(upper, t);
    }
    return lower.x < kReach && upper.x > -kReach && lower.y < kReach && upper.y > -kReach;
  }
  const hierarchy::PatchDomain& d = elements.domain[leaf.index()];
  const Shape& shape = scene[d.primitive].shape;
  const float smallest = std::min(relativeRadius(shape, d.v0), relativeRadius(shape, d.v1));
  const float um = 0.5f * (d.u0 + d.u1), apart = um - origin_.x;
  const float gap = std::max(0.0f, std::abs(apart - std::floor(apart + 0.5f)) - 0.5f * (d.u1 - d.u0));
  return gap * smallest * dualU_.x < kReach && (d.v0 - origin_.y) * dualV_.x < kReach &&
         (d.v1 - origin_.y) * dualV_.x > -kReach;
}

BoxF PatchSupport::bounds(const hierarchy::Elements& elements, hierarchy::ElementId leaf) const {
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  BoxF box;
  if (kind_ == Kind::Faces) {
    const Vec3f reach(kReach / dualU_.x);
    box = {g.center - reach, g.center + reach};
  } else if (flat()) {
    const hierarchy::PlaneFrame& f = elements.frames[elements.domain[leaf.index()].frame];
    const Rectangle r = rectangleOf(elements, leaf);
    const Vec2 half = 0.5 * (r.upper - r.lower);
    for (const double u : {-kReach, kReach})
      for (const double v : {-kReach, kReach}) box.extend(origin_ + Vec3f(u * half.x * f.edgeU + v * half.y * f.edgeV));
  } else {
    const Vec3f margin(kReach * glm::length(g.upper - g.lower));
    box = {g.lower - margin, g.upper + margin};
  }
  const Vec3f slack(1e-4f * glm::length(g.upper - g.lower));
  return {box.lower - slack, box.upper + slack};
}

}  // namespace deltalux::rendering
