#include "paper/separation.hpp"

#include <algorithm>
#include <cmath>

#include "hierarchy/outline.hpp"

namespace deltalux::paper {

namespace {

constexpr double kRounding = 0x1p-23;  // [rounding]

bool segmentMeetsRectangle(const Vec2& a, const Vec2& b, const Vec2& lower, const Vec2& upper) {
  // Clip the segment against the rectangle [LB84].
  double t0 = 0, t1 = 1;
  const Vec2 d = b - a;
  for (int axis = 0; axis < 2; ++axis) {
    if (d[axis] == 0) {
      if (a[axis] < lower[axis] || a[axis] > upper[axis]) return false;
      continue;
    }
    double enter = (lower[axis] - a[axis]) / d[axis], leave = (upper[axis] - a[axis]) / d[axis];
    if (enter > leave) std::swap(enter, leave);
    t0 = std::max(t0, enter), t1 = std::min(t1, leave);
    if (t0 > t1) return false;
  }
  return true;
}

/// Corners as a plane has them: heights above it, and the place below on it.
struct Corners {
  std::array<double, kMostCorners> height;
  std::array<Vec2, kMostCorners> foot;
  double low = kInfinity, high = -kInfinity;  // with what boxes of single precision may be off by

  Corners(const hierarchy::PlaneFrame& f, std::span<const Vec3> corners) {
    const double uu = glm::dot(f.edgeU, f.edgeU), uv = glm::dot(f.edgeU, f.edgeV), vv = glm::dot(f.edgeV, f.edgeV);
    const double determinant = uu * vv - uv * uv;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 q = corners[i] - f.origin;
      const double qu = glm::dot(q, f.edgeU), qv = glm::dot(q, f.edgeV);
      foot[i] = {(qu * vv - qv * uv) / determinant, (qv * uu - qu * uv) / determinant};
      height[i] = glm::dot(q, f.normal);
      const double off = kRounding * (std::abs(corners[i].x) + std::abs(corners[i].y) + std::abs(corners[i].z));
      low = std::min(low, height[i] - off), high = std::max(high, height[i] + off);
    }
  }
};

}  // namespace

std::array<Vec3, 8> cornersOf(const Vec3& lower, const Vec3& upper) {
  std::array<Vec3, 8> out;
  for (std::size_t i = 0; i < 8; ++i)
    out[i] = {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
  return out;
}

std::size_t cornersOf(const hierarchy::Elements& elements, hierarchy::ElementId e,
                      std::array<Vec3, kMostCorners>& out) {
  if (elements.isPatch(e) && elements.at(e).flat && elements.outline(e).size() <= out.size()) {
    const hierarchy::PlaneFrame& f = elements.frames[elements.domain[e.index()].frame];
    std::size_t n = 0;
    for (const Vec2& q : elements.outline(e)) out[n++] = f.at(q);
    return n;
  }
  const hierarchy::ElementGeometry& g = elements.shape(e);
  const auto box = cornersOf(Vec3(g.lower), Vec3(g.upper));
  std::copy(box.begin(), box.end(), out.begin());
  return box.size();
}

bool separates(const hierarchy::PlaneFrame& f, std::span<const Vec2> outline, std::span<const Vec3> a,
               std::span<const Vec3> b) {
  const Corners ca(f, a), cb(f, b);
  if (!((ca.high < 0 && cb.low > 0) || (ca.low > 0 && cb.high < 0))) return false;
  // All segments between corners cross the plane in the hull of these points; their rectangle must lie inside.
  Vec2 lower(kInfinity), upper(-kInfinity);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Vec2 p = glm::mix(ca.foot[i], cb.foot[j], ca.height[i] / (ca.height[i] - cb.height[j]));
      lower = glm::min(lower, p), upper = glm::max(upper, p);
      if (!(p.x >= 0 && p.y >= 0 && p.x <= 1 && p.y <= 1)) return false;
    }
  }
  if (!hierarchy::outlineContains(outline, 0.5 * (lower + upper))) return false;
  for (std::size_t k = 0; k < outline.size(); ++k)
    if (segmentMeetsRectangle(outline[k], outline[(k + 1) % outline.size()], lower, upper)) return false;
  return true;
}

}  // namespace deltalux::paper
