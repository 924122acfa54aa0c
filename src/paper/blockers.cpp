#include "paper/blockers.hpp"

#include <algorithm>
#include <array>

#include "base/tuning.hpp"
#include "paper/rounding.hpp"
#include "paper/separation.hpp"

namespace deltalux::paper {

namespace {

float reach(const Vec3f& lower, const Vec3f& upper, const Vec3f& p, const Vec3f& n) {
  return glm::dot(0.5f * (upper + lower) - p, n) + glm::dot(0.5f * (upper - lower), glm::abs(n));
}

struct Ends {
  const hierarchy::Elements& elements;
  hierarchy::ElementId receiver, sender;
  Shaft shaft;

  Ends(const hierarchy::Elements& e, hierarchy::ElementId r, hierarchy::ElementId s)
      : elements(e), receiver(r), sender(s), shaft(e.shape(r), e.shape(s)) {}

  bool sameSurface(hierarchy::ElementId patch, hierarchy::ElementId end) const {
    return elements.isPatch(end) &&
           elements.domain[patch.index()].primitive == elements.domain[end.index()].primitive &&
           elements.domain[patch.index()].triangle == elements.domain[end.index()].triangle;
  }

  /// A flat end is not blocked by what lies behind it.
  bool behindEnd(const hierarchy::ElementGeometry& g, hierarchy::ElementId end) const {
    const hierarchy::ElementGeometry& e = elements.shape(end);
    return elements.isPatch(end) && elements.at(end).flat &&
           reach(g.lower, g.upper, e.center, e.normal) <= roundingAlong(e.normal, e, g);
  }

  bool mayBlock(hierarchy::ElementId candidate) const {
    const hierarchy::ElementGeometry& g = elements.shape(candidate);
    if (!shaft.meets(g.lower, g.upper)) return false;
    if (elements.isPatch(candidate)) {
      if (elements.at(candidate).flat && (sameSurface(candidate, receiver) || sameSurface(candidate, sender)))
        return false;
      if (elements.at(candidate).flat) {
        // Both ends on one side of a polygon's plane: it stands between none of their points.
        const hierarchy::ElementGeometry &r = elements.shape(receiver), &s = elements.shape(sender);
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

  void collect(hierarchy::ElementId candidate, Blockers& out, std::size_t begin) const {
    if (!mayBlock(candidate)) return;
    if (!elements.isCluster(candidate) || out.size() - begin >= deltalux::tuning::kPilots) {
      out.push_back(candidate);
      return;
    }
    PrimitiveId last;
    std::uint32_t lastTriangle = 0;
    for (std::size_t i = 0; i < elements.at(candidate).childCount; ++i) {
      const hierarchy::ElementId c = elements.child(candidate, i);
      if (elements.isPatch(c)) {
        // Two sides of one surface block once.
        const hierarchy::PatchDomain& d = elements.domain[c.index()];
        if (d.primitive == last && d.triangle == lastTriangle) continue;
        last = d.primitive, lastTriangle = d.triangle;
      }
      collect(c, out, begin);
    }
  }
};

/// Ends whose own corners are tighter than their box.
bool flatEnd(const hierarchy::Elements& elements, hierarchy::ElementId e) {
  return elements.isPatch(e) && elements.at(e).flat;
}

}  // namespace

void shrinkBlockers(const hierarchy::Elements& elements, const Scene&, hierarchy::ElementId receiver,
                    hierarchy::ElementId sender, const hierarchy::ElementId* candidates, std::size_t count,
                    Blockers& out) {
  const Ends ends(elements, receiver, sender);
  const std::size_t begin = out.size();
  for (std::size_t i = 0; i < count; ++i) ends.collect(candidates[i], out, begin);
}

bool provablyBlocked(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId receiver,
                     hierarchy::ElementId sender, const hierarchy::ElementId* candidates, std::size_t count) {
  const float narrower =
      0.7f * std::min(elements.shape(receiver).radius,
                      elements.isDistant(sender) ? elements.shape(receiver).radius : elements.shape(sender).radius);
  std::array<Vec3, kMostCorners> r, s;
  std::size_t rCount = 0, sCount = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const hierarchy::ElementId c = candidates[i];
    if (!elements.isPatch(c) || !elements.at(c).flat || elements.at(c).blocker) continue;
    // Somewhere between the ends the shaft is as wide as the narrower of them: smaller polygons cannot close it.
    if (elements.shape(c).radius < narrower) continue;
    const hierarchy::ElementGeometry &polygon = elements.shape(c), &re = elements.shape(receiver),
                                     &se = elements.shape(sender);
    const bool apart = (reach(re.lower, re.upper, polygon.center, polygon.normal) < 0 &&
                        reach(se.lower, se.upper, polygon.center, -polygon.normal) < 0) ||
                       (reach(re.lower, re.upper, polygon.center, -polygon.normal) < 0 &&
                        reach(se.lower, se.upper, polygon.center, polygon.normal) < 0);
    if (!apart && !(flatEnd(elements, receiver) || flatEnd(elements, sender))) continue;
    const hierarchy::PatchDomain& d = elements.domain[c.index()];
    if (passesStraight(scene.materialOf(d.primitive))) continue;
    if (rCount == 0) rCount = cornersOf(elements, receiver, r), sCount = cornersOf(elements, sender, s);
    if (separates(elements.frames[d.frame], elements.outline(c), std::span(r).first(rCount),
                  std::span(s).first(sCount)))
      return true;
  }
  return false;
}

}  // namespace deltalux::paper
