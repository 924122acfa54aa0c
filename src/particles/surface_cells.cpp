#include "particles/surface_cells.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::particles {

namespace {

struct Halver {
  Vec2 size;
  UnitRect rect;

  /// Which coordinate the next cut halves, and where.
  int axis() const {
    constexpr double tie = 1 - 1e-6;  // equal sides stay equal when a motion rounds them apart
    return size.x * (rect.u1 - rect.u0) >= tie * size.y * (rect.v1 - rect.v0) ? 0 : 1;
  }
  double middle(int axis) const { return axis == 0 ? 0.5 * (rect.u0 + rect.u1) : 0.5 * (rect.v0 + rect.v1); }
  void take(int axis, bool upper) {
    const double m = middle(axis);
    if (axis == 0)
      (upper ? rect.u0 : rect.u1) = m;
    else
      (upper ? rect.v0 : rect.v1) = m;
  }
};

void collect(Halver h, int left, std::uint32_t code, int depth, std::vector<UnitCell>& cells) {
  if (left == 0) {
    cells.push_back({h.rect, code});
    return;
  }
  const int axis = h.axis();
  for (const bool upper : {false, true}) {
    Halver half = h;
    half.take(axis, upper);
    collect(half, left - 1, upper ? code | 0x80000000u >> depth : code, depth + 1, cells);
  }
}

}  // namespace

int halvings(double area, double limit) {
  if (!(area > limit) || !(limit > 0)) return 0;
  return std::min(kMostHalvings, static_cast<int>(std::ceil(std::log2(area / limit) - 1e-6)));
}

std::vector<UnitCell> cellsOf(const Vec2& size, int halvings) {
  std::vector<UnitCell> cells;
  cells.reserve(std::size_t(1) << halvings);
  collect({size, {}}, halvings, 0, 0, cells);
  return cells;
}

std::uint32_t cellAt(const Vec2& size, int halvings, const Vec2& p) {
  Halver h{size, {}};
  std::uint32_t index = 0;
  for (int i = 0; i < halvings; ++i) {
    const int axis = h.axis();
    const bool upper = p[axis] >= h.middle(axis);
    h.take(axis, upper);
    index = 2 * index + (upper ? 1u : 0u);
  }
  return index;
}

Vec2 sampleSize(const Shape& shape) {
  struct Visitor {
    Vec2 operator()(const Polygon& p) const {
      if (p.fillsFrame) return {glm::length(p.edgeU), glm::length(p.edgeV)};
      const double side = std::sqrt(p.area / static_cast<double>(p.triangles.size()));
      return {side * static_cast<double>(p.triangles.size()), side};
    }
    Vec2 operator()(const Sphere& s) const { return {2 * kPi * s.radius, 2 * s.radius}; }
    Vec2 operator()(const Cylinder& c) const { return {2 * kPi * c.radius, glm::length(c.p1 - c.p0)}; }
    Vec2 operator()(const Cone& c) const { return {kPi * (c.radius0 + c.radius1), glm::length(c.p1 - c.p0)}; }
    Vec2 operator()(const Ring& r) const {
      return {kPi * (r.innerRadius + r.outerRadius), r.outerRadius - r.innerRadius};
    }
    Vec2 operator()(const Mesh& m) const {
      const double side = std::sqrt(m.cumulativeArea.back() / static_cast<double>(m.triangles.size()));
      return {side * static_cast<double>(m.triangles.size()), side};
    }
  };
  return std::visit(Visitor{}, shape);
}

namespace {

/// Inverse of the choice of a triangle by area and of a point in it (scene/shape_kinds.hpp, choose and
/// uniformInTriangle).
Vec2 inTriangle(const std::vector<double>& cumulative, std::size_t triangle, const Vec2& w) {
  const Vec2 u = w.y > w.x ? Vec2(2 * w.x, w.x + w.y) : Vec2(w.x + w.y, 2 * w.y);
  const double below = triangle > 0 ? cumulative[triangle - 1] : 0.0;
  return {(below + std::clamp(u.x, 0.0, 1.0) * (cumulative[triangle] - below)) / cumulative.back(), u.y};
}

Vec2 inPolygon(const Polygon& p, const Vec2& uv) {
  if (p.fillsFrame) return uv;
  double best = -kInfinity;
  std::size_t found = 0;
  Vec2 weights(0);
  for (std::size_t t = 0; t < p.triangles.size(); ++t) {
    const Vec2 a = p.outline[p.triangles[t][0]], e1 = p.outline[p.triangles[t][1]] - a,
               e2 = p.outline[p.triangles[t][2]] - a, d = uv - a;
    const double area = e1.x * e2.y - e1.y * e2.x;
    const Vec2 w((d.x * e2.y - d.y * e2.x) / area, (e1.x * d.y - e1.y * d.x) / area);
    const double inside = std::min({w.x, w.y, 1 - w.x - w.y});
    if (inside > best) best = inside, found = t, weights = w;
  }
  return inTriangle(p.cumulativeArea, found, weights);
}

}  // namespace

Vec2 sampleNumbers(const Shape& shape, std::uint32_t triangle, const Vec2& uv) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return inPolygon(*polygon, uv);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return inTriangle(mesh->cumulativeArea, triangle, uv);
  const auto* cone = std::get_if<Cone>(&shape);
  if (!cone) return uv;
  // The area up to v grows as the square of the radius.
  const double r0 = cone->radius0, r1 = cone->radius1, r = r0 + uv.y * (r1 - r0);
  if (std::abs(r1 - r0) <= 1e-9 * (r0 + r1)) return uv;
  return {uv.x, (r * r - r0 * r0) / (r1 * r1 - r0 * r0)};
}

double coarse(double x) { return x > 0 ? std::exp2(std::floor(std::log2(x))) : 0.0; }

std::vector<std::uint32_t> topObjects(const Scene& scene) {
  std::vector<std::uint32_t> top;
  top.reserve(scene.primitives.size());
  for (const Primitive& p : scene.primitives) {
    ObjectId object = p.object;
    while (object.valid() && scene[object].parent.valid()) object = scene[object].parent;
    top.push_back(object.value);
  }
  return top;
}

}  // namespace deltalux::particles
