#include "radiosity/blockers.hpp"

#include <algorithm>
#include <array>

#include "hierarchy/outline.hpp"
#include "radiosity/rounding.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kOpenLimit = 48;  // longer lists keep clusters closed: rays are then cheaper than boxes

float reach(const Vec3f& lower, const Vec3f& upper, const Vec3f& p, const Vec3f& n) {
  return glm::dot(0.5f * (upper + lower) - p, n) + glm::dot(0.5f * (upper - lower), glm::abs(n));
}

struct Ends {
  const Elements& elements;
  ElementId receiver, sender;
  Shaft shaft;

  Ends(const Elements& e, ElementId r, ElementId s)
      : elements(e), receiver(r), sender(s), shaft(e.shape(r), e.shape(s)) {}

  bool sameSurface(ElementId patch, ElementId end) const {
    return elements.isPatch(end) &&
           elements.domain[patch.index()].primitive == elements.domain[end.index()].primitive &&
           elements.domain[patch.index()].triangle == elements.domain[end.index()].triangle;
  }

  /// A flat end is not blocked by what lies behind it.
  bool behindEnd(const ElementGeometry& g, ElementId end) const {
    const ElementGeometry& e = elements.shape(end);
    return elements.isPatch(end) && elements.at(end).flat &&
           reach(g.lower, g.upper, e.center, e.normal) <= roundingAlong(e.normal, e, g);
  }

  bool mayBlock(ElementId candidate) const {
    const ElementGeometry& g = elements.shape(candidate);
    if (!shaft.meets(g.lower, g.upper)) return false;
    if (elements.isPatch(candidate)) {
      if (elements.at(candidate).flat && (sameSurface(candidate, receiver) || sameSurface(candidate, sender)))
        return false;
      if (elements.at(candidate).flat) {
        // Both ends on one side of a polygon's plane: it stands between none of their points.
        const ElementGeometry &r = elements.shape(receiver), &s = elements.shape(sender);
        for (const float sign : {1.0f, -1.0f}) {
          const Vec3f n = sign * g.normal;
          const float touch = roundingAlong(n, r, g);
          if (reach(r.lower, r.upper, g.center, n) <= touch && reach(s.lower, s.upper, g.center, n) <= touch)
            return false;
        }
      }
    }
    return !behindEnd(g, receiver) && !behindEnd(g, sender);
  }

  void collect(ElementId candidate, Blockers& out, std::size_t begin) const {
    if (!mayBlock(candidate)) return;
    if (!elements.isCluster(candidate) || out.size() - begin >= kOpenLimit) {
      out.push_back(candidate);
      return;
    }
    PrimitiveId last;
    std::uint32_t lastTriangle = 0;
    for (std::size_t i = 0; i < elements.at(candidate).childCount; ++i) {
      const ElementId c = elements.child(candidate, i);
      if (elements.isPatch(c)) {
        // Two sides of one surface block once.
        const PatchDomain& d = elements.domain[c.index()];
        if (d.primitive == last && d.triangle == lastTriangle) continue;
        last = d.primitive, lastTriangle = d.triangle;
      }
      collect(c, out, begin);
    }
  }
};

/// Corners of what an end occupies: the outline of a flat patch, else its box.
std::size_t corners(const Elements& elements, ElementId e, std::array<Vec3, 12>& out) {
  if (elements.isPatch(e) && elements.at(e).flat && elements.outline(e).size() <= out.size()) {
    const PlaneFrame& f = elements.frames[elements.domain[e.index()].frame];
    std::size_t n = 0;
    for (const Vec2& q : elements.outline(e)) out[n++] = f.origin + q.x * f.edgeU + q.y * f.edgeV;
    return n;
  }
  const ElementGeometry& g = elements.shape(e);
  for (std::size_t i = 0; i < 8; ++i)
    out[i] = {i & 1 ? g.upper.x : g.lower.x, i & 2 ? g.upper.y : g.lower.y, i & 4 ? g.upper.z : g.lower.z};
  return 8;
}

/// Ends whose own corners are tighter than their box.
bool flatEnd(const Elements& elements, ElementId e) { return elements.isPatch(e) && elements.at(e).flat; }

bool segmentMeetsRectangle(const Vec2& a, const Vec2& b, const Vec2& lower, const Vec2& upper) {
  // Clip the segment against the rectangle [Liang & Barsky 1984].
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

}  // namespace

void shrinkBlockers(const Elements& elements, const Scene&, ElementId receiver, ElementId sender,
                    const ElementId* candidates, std::size_t count, Blockers& out) {
  const Ends ends(elements, receiver, sender);
  const std::size_t begin = out.size();
  for (std::size_t i = 0; i < count; ++i) ends.collect(candidates[i], out, begin);
}

bool provablyBlocked(const Elements& elements, const Scene& scene, ElementId receiver, ElementId sender,
                     const ElementId* candidates, std::size_t count) {
  const float narrower =
      0.7f * std::min(elements.shape(receiver).radius,
                      elements.isDistant(sender) ? elements.shape(receiver).radius : elements.shape(sender).radius);
  std::array<Vec3, 12> r, s;
  std::size_t rCount = 0, sCount = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ElementId c = candidates[i];
    if (!elements.isPatch(c) || !elements.at(c).flat || elements.at(c).blocker) continue;
    // Somewhere between the ends the shaft is as wide as the narrower of them: smaller polygons cannot close it.
    if (elements.shape(c).radius < narrower) continue;
    const ElementGeometry &polygon = elements.shape(c), &re = elements.shape(receiver), &se = elements.shape(sender);
    const bool apart = (reach(re.lower, re.upper, polygon.center, polygon.normal) < 0 &&
                        reach(se.lower, se.upper, polygon.center, -polygon.normal) < 0) ||
                       (reach(re.lower, re.upper, polygon.center, -polygon.normal) < 0 &&
                        reach(se.lower, se.upper, polygon.center, polygon.normal) < 0);
    if (!apart && !(flatEnd(elements, receiver) || flatEnd(elements, sender))) continue;
    const PatchDomain& d = elements.domain[c.index()];
    if (isThinGlass(scene.materialOf(d.primitive))) continue;
    const PlaneFrame& f = elements.frames[d.frame];
    if (rCount == 0) rCount = corners(elements, receiver, r), sCount = corners(elements, sender, s);
    // Strictly on opposite sides of the plane.
    double rLow = kInfinity, rHigh = -kInfinity, sLow = kInfinity, sHigh = -kInfinity;
    std::array<double, 12> rHeight, sHeight;
    for (std::size_t k = 0; k < rCount; ++k) {
      rHeight[k] = glm::dot(r[k] - f.origin, f.normal);
      rLow = std::min(rLow, rHeight[k]), rHigh = std::max(rHigh, rHeight[k]);
    }
    for (std::size_t k = 0; k < sCount; ++k) {
      sHeight[k] = glm::dot(s[k] - f.origin, f.normal);
      sLow = std::min(sLow, sHeight[k]), sHigh = std::max(sHigh, sHeight[k]);
    }
    if (!((rHigh < 0 && sLow > 0) || (rLow > 0 && sHigh < 0))) continue;
    // All segments between corners cross the plane in the hull of these points; their rectangle must lie inside.
    const double uu = glm::dot(f.edgeU, f.edgeU), uv = glm::dot(f.edgeU, f.edgeV), vv = glm::dot(f.edgeV, f.edgeV);
    const double determinant = uu * vv - uv * uv;
    Vec2 lower(kInfinity), upper(-kInfinity);
    bool within = true;
    for (std::size_t a = 0; a < rCount && within; ++a) {
      for (std::size_t b = 0; b < sCount && within; ++b) {
        const double t = rHeight[a] / (rHeight[a] - sHeight[b]);
        const Vec3 q = glm::mix(r[a], s[b], t) - f.origin;
        const double qu = glm::dot(q, f.edgeU), qv = glm::dot(q, f.edgeV);
        const Vec2 p{(qu * vv - qv * uv) / determinant, (qv * uu - qu * uv) / determinant};
        lower = glm::min(lower, p), upper = glm::max(upper, p);
        within = p.x >= 0 && p.y >= 0 && p.x <= 1 && p.y <= 1;
      }
    }
    if (!within) continue;
    const auto outline = elements.outline(c);
    if (!outlineContains(outline, 0.5 * (lower + upper))) continue;
    bool inside = true;
    for (std::size_t k = 0; k < outline.size() && inside; ++k)
      inside = !segmentMeetsRectangle(outline[k], outline[(k + 1) % outline.size()], lower, upper);
    if (inside) return true;
  }
  return false;
}

}  // namespace deltalux
