#pragma once
// Light through a refracting ball: in, some reflections inside, and out. All ways from one point to another place, and
// how much they spread the light.
//
// The way lies in the plane of both ends and the centre. With D the distance of x from the centre and alpha the angle
// at x between the ray and the centre, the ray passes the centre at D sin alpha before and after, and turns towards it
// by 2 (i - t) + k (pi - 2 t) after k inner reflections, i and t being the angles of incidence and refraction: the
// condition that it meets the other end is one equation in alpha, and its derivative gives the spread. Cost: some
// microseconds a pair of ends.
#include <array>
#include <deltalux/shape.hpp>

#include "render/reference/curved_mirror.hpp"

namespace deltalux::rendering {

struct BallPassage {
  Vec3 entry, exit;             // on the sphere
  Vec3 direction;               // unit, behind the ball
  double cosIncidence;          // outside, the same at entry and exit
  double inside;                // length within the ball
  std::array<Vec3, 4> corners;  // inner reflections
};

struct BallPassages {
  std::array<BallPassage, 8> list;
  int count = 0;
};

/// The passage with `inner` reflections that enters at `entry`, coming from `x` outside. `ior` of the ball over the
/// outside, above 1.
BallPassage passageFrom(const Sphere&, double ior, int inner, const Vec3& x, const Vec3& entry);
/// Every passage with `inner` reflections from `x` to `light`, both outside the ball.
BallPassages ballPassages(const Sphere&, double ior, int inner, const Vec3& x, const LightPlace& light);
/// Cross-section per solid angle at x at distance `after` behind the exit [unit^2/sr]; solid angle ratio when infinite.
double passageSpread(const Sphere&, double ior, int inner, const Vec3& x, const BallPassage&, double after);

}  // namespace deltalux::rendering
