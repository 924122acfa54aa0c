// Cells that particles are aimed at, by chance, and points of theirs.
#include <algorithm>

#include "particles/receivers.hpp"

namespace deltalux::particles {

std::uint32_t Receivers::choose(const RadixNode& node, double u) const {
  const double target = cumulative_[node.begin] + u * weightOf(node);
  const auto first = cumulative_.begin() + node.begin + 1, last = cumulative_.begin() + node.end;
  return static_cast<std::uint32_t>(std::upper_bound(first, last, target) - cumulative_.begin() - 1);
}

Rectangle Receivers::rectangle(std::uint32_t cell) const {
  const Cell& c = cells_[cell];
  const Rectangle& f = surfaces_[c.surface].frame;
  return {f.at({c.rect.u0, c.rect.v0}), f.a, f.b, (c.rect.u1 - c.rect.u0) * f.lengthA,
          (c.rect.v1 - c.rect.v0) * f.lengthB};
}

bool Receivers::onSurface(const Surface& s, const Vec3& p) const {
  const Shape& shape = scene_[s.primitive].shape;
  if (const auto* ring = std::get_if<Ring>(&shape)) {
    const double r = glm::distance(p, ring->center);
    return r >= ring->innerRadius && r <= ring->outerRadius;
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const auto& t = mesh->triangles[s.triangle];
    const Vec3 p0 = mesh->positions[t[0]], e1 = mesh->positions[t[1]] - p0, e2 = mesh->positions[t[2]] - p0;
    const Vec3 n = glm::cross(e1, e2);
    const double squared = glm::dot(n, n);
    const double u = glm::dot(glm::cross(p - p0, e2), n) / squared, v = glm::dot(glm::cross(e1, p - p0), n) / squared;
    return u >= 0 && v >= 0 && u + v <= 1;
  }
  const auto& polygon = std::get<Polygon>(shape);
  const Vec3 d = p - polygon.origin;
  return covers(shape, {glm::dot(d, polygon.dualU), glm::dot(d, polygon.dualV)});
}

std::optional<ReceiverPoint> Receivers::flatPoint(std::uint32_t cell, const Vec3& position) const {
  const Surface& s = surfaces_[cells_[cell].surface];
  if (!s.fills && !onSurface(s, position)) return std::nullopt;
  const Shape& shape = scene_[s.primitive].shape;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return ReceiverPoint{position, polygon->normal};
  if (const auto* ring = std::get_if<Ring>(&shape)) return ReceiverPoint{position, ring->normal};
  const auto& mesh = std::get<Mesh>(shape);
  const auto& t = mesh.triangles[s.triangle];
  const Vec3& p0 = mesh.positions[t[0]];
  return ReceiverPoint{position, glm::normalize(glm::cross(mesh.positions[t[1]] - p0, mesh.positions[t[2]] - p0))};
}

ReceiverPoint Receivers::curvedPoint(std::uint32_t cell, const Vec2& u) const {
  const Cell& c = cells_[cell];
  const SurfacePoint p = samplePoint(scene_[surfaces_[c.surface].primitive].shape, c.rect.at(u));
  return {p.position, p.normal};
}

std::uint32_t Receivers::cellOf(const tracing::Hit& hit) const {
  const std::uint32_t first = surfaceOf_[hit.primitive.index()];
  if (first == RadixNode::kNone) return RadixNode::kNone;
  const Surface& s = surfaces_[first + hit.triangle];
  if (s.halvings == 0 || s.firstCell == RadixNode::kNone) return s.firstCell;
  const Vec3 p(hit.position);
  Vec2 at;
  if (s.flat) {
    const Vec3 d = p - s.frame.corner;
    at = {glm::dot(d, s.frame.a) / s.frame.lengthA, glm::dot(d, s.frame.b) / s.frame.lengthB};
  } else {
    const Shape& shape = scene_[s.primitive].shape;
    at = sampleNumbers(shape, 0, parameterAt(shape, p));
  }
  return s.firstCell + cellAt(s.size, s.halvings, at);
}

}  // namespace deltalux::particles
