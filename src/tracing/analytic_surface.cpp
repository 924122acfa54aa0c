#include "tracing/analytic_surface.hpp"

#include <algorithm>

namespace deltalux::tracing {

namespace {
Vec3 rejection(const Vec3& v, const Vec3& unitAxis) { return v - glm::dot(v, unitAxis) * unitAxis; }
}  // namespace

SphereSurface::SphereSurface(const Sphere& s)
    : center(s.center), radiusSquared(s.radius * s.radius), perRadius((s.inward ? -1 : 1) / s.radius) {}

Crossings SphereSurface::crossings(const Vec3& origin, const Vec3& direction) const {
  Crossings found;
  const Vec3 f = origin - center;
  const double a = glm::dot(direction, direction), middle = -glm::dot(f, direction) / a;
  const Vec3 nearest = f + middle * direction;
  const double gap = radiusSquared - glm::dot(nearest, nearest);
  if (!(gap >= 0)) return found;
  const double half = std::sqrt(gap / a);
  found.add(middle - half), found.add(middle + half);
  return found;
}

CylinderSurface::CylinderSurface(const Cylinder& c)
    : base(c.p0),
      axis(glm::normalize(c.p1 - c.p0)),
      height(glm::distance(c.p0, c.p1)),
      radiusSquared(c.radius * c.radius),
      perRadius((c.inward ? -1 : 1) / c.radius) {}

Crossings CylinderSurface::crossings(const Vec3& origin, const Vec3& direction) const {
  Crossings found;
  const Vec3 f = origin - base;
  const double fAlong = glm::dot(f, axis), dAlong = glm::dot(direction, axis);
  const Vec3 fAcross = f - fAlong * axis, dAcross = direction - dAlong * axis;
  const double a = glm::dot(dAcross, dAcross);
  if (!(a > 1e-20)) return found;  // along the axis
  const double middle = -glm::dot(fAcross, dAcross) / a;
  const Vec3 nearest = fAcross + middle * dAcross;
  const double gap = radiusSquared - glm::dot(nearest, nearest);
  if (!(gap >= 0)) return found;
  const double half = std::sqrt(gap / a);
  for (const double t : {middle - half, middle + half}) {
    const double along = fAlong + t * dAlong;
    if (along >= 0 && along <= height) found.add(t);
  }
  return found;
}

Vec3 CylinderSurface::normal(const Vec3& p) const { return rejection(p - base, axis) * perRadius; }

ConeSurface::ConeSurface(const Cone& c)
    : base(c.p0),
      axis(glm::normalize(c.p1 - c.p0)),
      height(glm::distance(c.p0, c.p1)),
      radius(c.radius0),
      slope((c.radius1 - c.radius0) / glm::distance(c.p0, c.p1)),
      side(c.inward ? -1 : 1) {}

Crossings ConeSurface::crossings(const Vec3& origin, const Vec3& direction) const {
  Crossings found;
  // From the point of the line nearest to the middle of the axis: the coefficients stay of the cone's own size.
  const double shift = -glm::dot(origin - (base + 0.5 * height * axis), direction) / glm::dot(direction, direction);
  const Vec3 f = origin + shift * direction - base;
  const double fAlong = glm::dot(f, axis), dAlong = glm::dot(direction, axis);
  const Vec3 fAcross = f - fAlong * axis, dAcross = direction - dAlong * axis;
  const double fRadius = radius + slope * fAlong, dRadius = slope * dAlong;

  // |fAcross + t dAcross|^2 = (fRadius + t dRadius)^2
  const double a = glm::dot(dAcross, dAcross) - dRadius * dRadius;
  const double b = glm::dot(fAcross, dAcross) - fRadius * dRadius;
  const double c = glm::dot(fAcross, fAcross) - fRadius * fRadius;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return found;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double first = q / a, second = q != 0 ? c / q : first;  // a is 0 along a slant line: one of them is infinite
  if (first > second) std::swap(first, second);
  for (const double t : {first, second}) {
    const double along = fAlong + t * dAlong;
    if (along >= 0 && along <= height) found.add(t + shift);
  }
  return found;
}

Vec3 ConeSurface::normal(const Vec3& p) const {
  const Vec3 radial = rejection(p - base, axis);
  const double length = glm::length(radial);
  if (!(length > 0)) return side * std::copysign(1.0, -slope) * axis;  // the apex
  return side * glm::normalize(radial / length - slope * axis);
}

RingSurface::RingSurface(const Ring& r)
    : center(r.center),
      front(r.normal),
      innerSquared(r.innerRadius * r.innerRadius),
      outerSquared(r.outerRadius * r.outerRadius) {}

Crossings RingSurface::crossings(const Vec3& origin, const Vec3& direction) const {
  Crossings found;
  const Vec3 f = origin - center;
  const double t = -glm::dot(f, front) / glm::dot(direction, front);
  const Vec3 offset = f + t * direction;
  const double squared = glm::dot(offset, offset);
  if (squared >= innerSquared && squared <= outerSquared) found.add(t);
  return found;
}

ThinTriangleSurface::ThinTriangleSurface(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& unitNormal)
    : corners{a, b, c}, front(unitNormal) {}

Crossings ThinTriangleSurface::crossings(const Vec3& origin, const Vec3& direction) const {
  Crossings found;
  const double t = glm::dot(corners[0] - origin, front) / glm::dot(direction, front);
  if (!std::isfinite(t)) return found;
  const Vec3 p = origin + t * direction;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    if (!(glm::dot(glm::cross(b - a, p - a), front) >= 0)) return found;
  }
  found.add(t);
  return found;
}

}  // namespace deltalux::tracing
