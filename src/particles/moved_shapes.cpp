#include "particles/moved_shapes.hpp"
#include "base/square.hpp"

#include <algorithm>

namespace deltalux::particles {

namespace {

constexpr std::size_t kLeaf = 2;  // pieces of a box that is not split [task]

/// The part of a segment where a linear function, f0 at its start and f1 at its end, lies in [low, high]; false: none.
bool clip(Vec3& a, Vec3& b, double f0, double f1, double low, double high) {
  if ((f0 < low && f1 < low) || (f0 > high && f1 > high)) return false;
  const Vec3 from = a, d = b - a;
  const auto at = [&](double f) { return from + (f - f0) / (f1 - f0) * d; };
  if (f0 < low)
    a = at(low);
  else if (f0 > high)
    a = at(high);
  if (f1 < low)
    b = at(low);
  else if (f1 > high)
    b = at(high);
  return true;
}

double distanceSquared(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double squared = glm::dot(d, d);
  const double t = squared > 0 ? std::clamp(glm::dot(p - a, d) / squared, 0.0, 1.0) : 0.0;
  const Vec3 to = a + t * d - p;
  return glm::dot(to, to);
}

/// The least value in [0, 1] of a convex function, to a millionth of its reach.
template <class Function>
double least(const Function& f) {
  double low = 0, high = 1;
  for (int i = 0; i < 34; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (f(a) < f(b))
      high = b;
    else
      low = a;
  }
  return f(0.5 * (low + high));
}

}  // namespace

MovedShapes::MovedShapes(std::span<const Shape* const> shapes, double margin) : margin_(margin) {
  std::vector<Boxed> boxed;
  for (const Shape* s : shapes)
    if (area(*s) > 0) addPieces(*s, boxed);
  if (!boxed.empty()) build(boxed, 0, boxed.size());
  for (Boxed& b : boxed) pieces_.push_back(std::move(b.second));
}

MovedShapes::Facet MovedShapes::facet(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 corners[3] = {a, b, c}, n = glm::cross(b - a, c - a);
  Facet f;
  f.normal = n / glm::length(n), f.offset = glm::dot(f.normal, a);
  for (int i = 0; i < 3; ++i) {
    const Vec3 along = corners[(i + 1) % 3] - corners[i];
    f.edges[i] = glm::normalize(glm::cross(along, f.normal));
    f.bounds[i] = glm::dot(f.edges[i], corners[i]);
  }
  return f;
}

void MovedShapes::addPieces(const Shape& shape, std::vector<Boxed>& to) {
  const auto addTriangles = [&](const std::vector<Vec3>& corners, const auto& triangles) {
    for (const auto& [a, b, c] : triangles) {
      if (!(glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a])) > 0)) continue;
      Box box;
      box.extend(corners[a]), box.extend(corners[b]), box.extend(corners[c]);
      to.emplace_back(box, facet(corners[a], corners[b], corners[c]));
    }
  };
  const auto barrel = [](const Vec3& p0, const Vec3& p1, double r0, double r1) {
    const double height = glm::distance(p0, p1);
    return Barrel{p0, (p1 - p0) / height, height, r0, (r1 - r0) / height};
  };
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return addTriangles(polygon->vertices, polygon->triangles);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return addTriangles(mesh->positions, mesh->triangles);
  const Box box = bounds(shape);
  if (const auto* s = std::get_if<Sphere>(&shape)) to.emplace_back(box, *s);
  if (const auto* r = std::get_if<Ring>(&shape)) to.emplace_back(box, *r);
  if (const auto* c = std::get_if<Cylinder>(&shape)) to.emplace_back(box, barrel(c->p0, c->p1, c->radius, c->radius));
  if (const auto* c = std::get_if<Cone>(&shape)) to.emplace_back(box, barrel(c->p0, c->p1, c->radius0, c->radius1));
}

void MovedShapes::build(std::vector<Boxed>& pieces, std::size_t begin, std::size_t end) {
  Box box;
  for (std::size_t i = begin; i < end; ++i) box.extend(pieces[i].first);
  const std::size_t node = nodes_.size();
  nodes_.push_back({SegmentBox(box, margin_), std::uint32_t(begin), std::uint32_t(end)});
  if (end - begin <= kLeaf) return;
  const Vec3 extent = box.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t i) { return pieces.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Boxed& a, const Boxed& b) { return a.first.center()[axis] < b.first.center()[axis]; });
  build(pieces, begin, middle);
  nodes_[node].second = static_cast<std::uint32_t>(nodes_.size());
  build(pieces, middle, end);
}

bool MovedShapes::meets(const Vec3f& a, const Vec3f& b) const {
  constexpr std::size_t kDeep = 64;  // [limit]
  std::uint32_t stack[kDeep];
  std::size_t open = 0;
  if (!nodes_.empty()) stack[open++] = 0;
  while (open > 0) {
    const std::uint32_t n = stack[--open];
    const Node& node = nodes_[n];
    if (!node.box.meets(a, b)) continue;
    if (node.second) {
      stack[open++] = node.second, stack[open++] = n + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      if (std::visit([&](const auto& piece) { return meets(piece, Vec3(a), Vec3(b)); }, pieces_[i])) return true;
  }
  return false;
}

bool MovedShapes::meets(const Facet& f, const Vec3& from, const Vec3& to) const {
  Vec3 a = from, b = to;
  const double plane[2] = {glm::dot(f.normal, a) - f.offset, glm::dot(f.normal, b) - f.offset};
  if (!clip(a, b, plane[0], plane[1], -margin_, margin_)) return false;
  for (int i = 0; i < 3; ++i)
    if (std::min(glm::dot(f.edges[i], a), glm::dot(f.edges[i], b)) > f.bounds[i] + margin_) return false;
  return true;
}

bool MovedShapes::meets(const Barrel& c, const Vec3& from, const Vec3& to) const {
  Vec3 a = from - c.foot, b = to - c.foot;
  const double high[2] = {glm::dot(c.axis, a), glm::dot(c.axis, b)};
  if (!clip(a, b, high[0], high[1], -margin_, c.height + margin_)) return false;
  const auto flat = [&](const Vec3& p) { return p - glm::dot(p, c.axis) * c.axis; };
  const auto radius = [&](const Vec3& p) { return c.radius + c.slope * glm::dot(p, c.axis); };
  const double margin = margin_ * std::sqrt(1 + square(c.slope));
  const Vec3 p = flat(a), q = flat(b);
  const double r = radius(a), s = radius(b);
  // How far out of the barrel: convex along the segment, so inside where both ends are.
  const auto outside = [&](double t) { return glm::length(p + t * (q - p)) - (r + t * (s - r)); };
  if (outside(0) < -margin && outside(1) < -margin) return false;
  if (c.slope == 0) return distanceSquared(Vec3(0), p, q) <= square(c.radius + margin);
  return least(outside) <= 2 * margin;
}

bool MovedShapes::meets(const Sphere& s, const Vec3& a, const Vec3& b) const {
  if (distanceSquared(s.center, a, b) > square(s.radius + margin_)) return false;
  const double within = s.radius - margin_;
  return !(glm::distance(a, s.center) < within && glm::distance(b, s.center) < within);
}

bool MovedShapes::meets(const Ring& r, const Vec3& from, const Vec3& to) const {
  Vec3 a = from - r.center, b = to - r.center;
  const double plane[2] = {glm::dot(r.normal, a), glm::dot(r.normal, b)};
  if (!clip(a, b, plane[0], plane[1], -margin_, margin_)) return false;
  if (distanceSquared(Vec3(0), a, b) > square(r.outerRadius + 2 * margin_)) return false;
  const double within = r.innerRadius - 2 * margin_;
  return !(glm::length(a) < within && glm::length(b) < within);
}

}  // namespace deltalux::particles
