#pragma once
// The turns that a curved bend offers between a point and a light: mirror points or passages through a ball, in one
// form.
#include "render/reference/curved_mirror.hpp"
#include "render/reference/light_connections.hpp"
#include "render/reference/refracting_ball.hpp"

namespace deltalux::rendering {

struct Turn {
  Vec3 in, inNormal;    // where the bend is met from the point
  Vec3 out, outNormal;  // where it is left towards the light; the same on a mirror
  std::array<Vec3, kMostInner> inner;
  int innerCount = 0;
  Vec3 onward;        // unit, from `out` to the light
  double after = 0;   // distance from there to the light
  double spread = 0;  // cross-section at the light per solid angle at the point [unit^2/sr], or solid angles
  Rgb passed{0.0f};   // that is reflected or transmitted
};

struct Turns {
  std::array<Turn, 8> list;
  int count = 0;
};

Turns findTurns(const ReferenceScene&, const Bend&, const Vec3& from, const LightPlace&);

}  // namespace deltalux::rendering
