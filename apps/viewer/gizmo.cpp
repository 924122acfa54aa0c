#include "gizmo.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "camera.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kShareOfView = 0.11;    // length of an axis, of the height of the view at its distance
constexpr double kPlaneAt = 0.3;         // corner of a plane's square nearest to the centre, of the size
constexpr double kPlaneTo = 0.55;        // and the farthest
constexpr double kRing = 0.85;           // radius of the rings
constexpr int kRingSteps = 64;           // lines a ring: round to the eye
constexpr double kEdgeOn = 0.12;         // cosine below which a ring's plane is no measure: its tangent is then
constexpr double kParallel = 1e-9;       // of squared sine and of cosine, where two directions count as one
constexpr double kHalfTurn = 180 / kPi;  // degrees a radian

double snapped(double value, double step) { return step > 0 ? step * std::round(value / step) : value; }

std::optional<GizmoDrag> moved(const Gizmo& g, const Vec3& along, const Snap& snap) {
  GizmoDrag drag;
  for (int i = 0; i < 3; ++i) drag.offset[i] = snapped(along[i], snap.length);
  drag.matrix[3] = glm::dvec4(g.axes * drag.offset, 1);
  return drag;
}

std::optional<GizmoDrag> movedAlong(const Gizmo& g, int axis, const ViewRay& from, const ViewRay& to,
                                    const Snap& snap) {
  const auto a = alongLine(from, g.centre, g.axes[axis]), b = alongLine(to, g.centre, g.axes[axis]);
  if (!a || !b) return std::nullopt;
  Vec3 along(0);
  along[axis] = *b - *a;
  return moved(g, along, snap);
}

std::optional<GizmoDrag> movedAcross(const Gizmo& g, int axis, const ViewRay& from, const ViewRay& to,
                                     const Snap& snap) {
  const auto a = onPlane(from, g.centre, g.axes[axis]), b = onPlane(to, g.centre, g.axes[axis]);
  if (!a || !b) return std::nullopt;
  Vec3 along = glm::transpose(g.axes) * (*b - *a);
  along[axis] = 0;
  return moved(g, along, snap);
}

/// Radians about an axis; by its plane, or where that is seen edge-on by the way along the ring's tangent.
std::optional<double> turnedBy(const Gizmo& g, int axis, const ViewRay& from, const ViewRay& to) {
  const Vec3 n = g.axes[axis];
  const auto a = onPlane(from, g.centre, n);
  if (std::abs(glm::dot(from.direction, n)) > kEdgeOn) {
    const auto b = onPlane(to, g.centre, n);
    if (!a || !b) return std::nullopt;
    const Vec3 p = *a - g.centre, q = *b - g.centre;
    return std::atan2(glm::dot(n, glm::cross(p, q)), glm::dot(p, q));
  }
  // The point of the ring on the eye's side moves across the line of sight.
  const Vec3 toEye = from.origin - g.centre;
  const Vec3 tangent = glm::cross(n, toEye - glm::dot(toEye, n) * n);
  if (glm::dot(tangent, tangent) < kParallel * glm::dot(toEye, toEye)) return std::nullopt;
  const Vec3 unit = glm::normalize(tangent);
  const auto s = alongLine(from, g.centre, unit), t = alongLine(to, g.centre, unit);
  if (!s || !t) return std::nullopt;
  return (*t - *s) / (kRing * g.size);
}

/// Distance of a point from a piece of a line, all in pixels.
double distanceTo(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double length2 = glm::dot(d, d);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0;
  return glm::length(p - a - t * d);
}

bool insideConvex(const std::vector<Vec2>& outline, const Vec2& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    left |= side > 0, right |= side < 0;
  }
  return !(left && right);
}
}  // namespace

int axisOf(Handle h) {
  switch (h) {
    case Handle::MoveX:
    case Handle::MoveYZ:
    case Handle::TurnX:
      return 0;
    case Handle::MoveY:
    case Handle::MoveZX:
    case Handle::TurnY:
      return 1;
    default:
      return 2;
  }
}
bool moves(Handle h) { return h >= Handle::MoveX && h <= Handle::MoveXY; }
bool movesAlong(Handle h) { return h >= Handle::MoveX && h <= Handle::MoveZ; }

Gizmo gizmoAt(const Vec3& centre, const glm::dmat3& axes, const View& v) {
  const double depth = glm::dot(centre - v.position, glm::normalize(v.direction));
  const double height =
      v.kind == View::Kind::Parallel ? v.vertical : 2 * std::max(depth, 0.0) * std::tan(glm::radians(v.vertical) / 2);
  return {centre, axes, std::max(kShareOfView * height, 1e-6)};
}

std::vector<Vec3> outline(const Gizmo& g, Handle h) {
  const int axis = axisOf(h);
  if (h == Handle::None) return {};
  if (movesAlong(h)) return {g.centre, g.centre + g.size * g.axes[axis]};
  const Vec3 u = g.size * g.axes[(axis + 1) % 3], v = g.size * g.axes[(axis + 2) % 3];
  std::vector<Vec3> points;
  if (moves(h)) {
    for (const auto& [s, t] :
         {std::pair{kPlaneAt, kPlaneAt}, {kPlaneTo, kPlaneAt}, {kPlaneTo, kPlaneTo}, {kPlaneAt, kPlaneTo}})
      points.push_back(g.centre + s * u + t * v);
  } else {
    for (int i = 0; i < kRingSteps; ++i) {
      const double angle = 2 * kPi * i / kRingSteps;
      points.push_back(g.centre + kRing * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  return points;
}

Handle handleAt(const Gizmo& g, const View& view, int width, int height, double x, double y, double reach) {
  Handle best = Handle::None;
  double nearest = reach;
  const Vec2 cursor(x, y);
  for (const Handle h : kHandles) {
    std::vector<Vec2> pixels;
    bool seen = true;
    for (const Vec3& p : outline(g, h)) {
      const Vec3 at = project(view, width, height, p);
      seen &= at.z > 0;
      pixels.emplace_back(at);
    }
    if (!seen) continue;
    const std::size_t lines = movesAlong(h) ? 1 : pixels.size();
    for (std::size_t i = 0; i < lines; ++i) {
      const double d = distanceTo(cursor, pixels[i], pixels[(i + 1) % pixels.size()]);
      if (d < nearest) nearest = d, best = h;
    }
    if (moves(h) && !movesAlong(h) && insideConvex(pixels, cursor)) return h;
  }
  return best;
}

std::optional<GizmoDrag> dragged(const Gizmo& g, Handle h, const ViewRay& from, const ViewRay& to, const Snap& snap) {
  if (h == Handle::None) return std::nullopt;
  const int axis = axisOf(h);
  if (movesAlong(h)) return movedAlong(g, axis, from, to, snap);
  if (moves(h)) return movedAcross(g, axis, from, to, snap);
  const auto radians = turnedBy(g, axis, from, to);
  if (!radians) return std::nullopt;
  GizmoDrag drag;
  drag.degrees = snapped(kHalfTurn * *radians, snap.degrees);
  drag.matrix = rotationAbout(g.centre, g.axes[axis], drag.degrees);
  return drag;
}

Mat4 rotationAbout(const Vec3& point, const Vec3& axis, double degrees) {
  const Mat4 there = glm::translate(Mat4(1.0), point);
  return glm::translate(glm::rotate(there, glm::radians(degrees), axis), -point);
}

Mat4 inFiles(const Mat4& inScene, const Vec3& origin) {
  return glm::translate(Mat4(1.0), origin) * inScene * glm::translate(Mat4(1.0), -origin);
}

std::optional<double> alongLine(const ViewRay& ray, const Vec3& point, const Vec3& direction) {
  // Least distance of two lines: both of its ends lie across from both directions.
  const Vec3 w = point - ray.origin;
  const double a = glm::dot(direction, direction), b = glm::dot(direction, ray.direction);
  const double c = glm::dot(ray.direction, ray.direction);
  const double denominator = a * c - b * b;
  if (denominator < kParallel * a * c) return std::nullopt;
  return (b * glm::dot(ray.direction, w) - c * glm::dot(direction, w)) / denominator;
}

std::optional<Vec3> onPlane(const ViewRay& ray, const Vec3& point, const Vec3& normal) {
  const double cosine = glm::dot(ray.direction, normal);
  if (std::abs(cosine) < kParallel) return std::nullopt;
  const double t = glm::dot(point - ray.origin, normal) / cosine;
  if (t <= 0) return std::nullopt;
  return ray.origin + t * ray.direction;
}

}  // namespace deltalux::viewer
