#include "render/reference/refracting_ball.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/tuning.hpp"

namespace deltalux::rendering {

namespace {

/// Between which roots are looked for.
constexpr int kRootSteps = deltalux::tuning::kPolarAngles;

/// The ray from x at angle alpha to the centre, in the plane of the passage.
struct Bending {
  double sinI, cosI, sinT, cosT;
  double turned;  // direction behind the ball, as an angle from the axis x -> centre
  double slope;   // d turned / d alpha
};

/// What the ends' equation knows of the ball: D, radius, index, inner reflections.
struct Course {
  double distance, radius, ior;
  int inner;
};

Bending bend(const Course& c, double alpha) {
  const auto [distance, radius, ior, inner] = c;
  Bending b;
  b.sinI = std::clamp(distance * std::sin(alpha) / radius, -1.0, 1.0);
  b.sinT = b.sinI / ior;
  b.cosI = std::sqrt(1.0 - b.sinI * b.sinI), b.cosT = std::sqrt(1.0 - b.sinT * b.sinT);
  const double t = std::asin(b.sinT);
  b.turned = alpha - 2.0 * (std::asin(b.sinI) - t) - inner * (std::copysign(kPi, alpha) - 2.0 * t);
  const double step = distance * std::cos(alpha) / radius;
  b.slope = 1.0 - 2.0 * (step / std::max(b.cosI, 1e-12) - (1 + inner) * step / (ior * b.cosT));
  return b;
}

/// Where the ray from x misses the other end by: signed offset, or for infinite light the angle.
struct Miss {
  Course course;
  Vec2 light;  // relative to x, first coordinate towards the centre; for infinite light (angle, -)
  bool infinite;

  double operator()(double alpha) const {
    const Bending b = bend(course, alpha);
    if (infinite) return std::remainder(b.turned - light.x, 2.0 * kPi);
    return std::cos(b.turned) * light.y - std::sin(b.turned) * (light.x - course.distance) -
           course.distance * std::sin(alpha);
  }
};

double rootOfMiss(const Miss& f, double a, double fa, double b) {
  for (int i = 0; i < 52; ++i) {
    const double m = 0.5 * (a + b), fm = f(m);
    if ((fm > 0) == (fa > 0))
      a = m;
    else
      b = m;
  }
  return 0.5 * (a + b);
}

/// The extremum of f between two angles by golden sections, for a pair of roots that no sample separates.
double extremumOfMiss(const Miss& f, double a, double b, double sign) {
  constexpr double kGolden = 0.6180339887498949;  // [defined]
  for (int i = 0; i < 30; ++i) {
    const double left = b - kGolden * (b - a), right = a + kGolden * (b - a);
    if (sign * f(left) < sign * f(right))
      b = right;
    else
      a = left;
  }
  return 0.5 * (a + b);
}

BallPassage makePassage(const Sphere& sphere, const Course& course, const Vec3& x, const Vec3& axis, const Vec3& side,
                        double alpha) {
  const double distance = course.distance;
  const Bending b = bend(course, alpha);
  BallPassage p;
  const Vec3 d = std::cos(alpha) * axis + std::sin(alpha) * side;
  p.entry = x + (distance * std::cos(alpha) - sphere.radius * b.cosI) * d;
  p.direction = std::cos(b.turned) * axis + std::sin(b.turned) * side;
  // Behind the ball the ray passes the centre as far off as before, and leaves it at cos i.
  const Vec3 across = -std::sin(b.turned) * axis + std::cos(b.turned) * side;
  p.exit = sphere.center + distance * std::sin(alpha) * across + sphere.radius * b.cosI * p.direction;
  p.cosIncidence = b.cosI;
  p.inside = 2.0 * sphere.radius * b.cosT * (1 + course.inner);
  const Vec3 entered = p.entry - sphere.center;
  const double start = std::atan2(glm::dot(entered, side), glm::dot(entered, axis));
  const double chord =
      std::copysign(kPi, alpha) - 2.0 * std::asin(b.sinT);  // the angle that a chord fills at the centre
  for (int k = 0; k < course.inner; ++k) {
    const double angle = start - (k + 1) * chord;
    p.corners[k] = sphere.center + sphere.radius * (std::cos(angle) * axis + std::sin(angle) * side);
  }
  return p;
}

/// The unit part of v at right angles to the unit `axis`.
Vec3 sideOf(const Vec3& v, const Vec3& axis) {
  const Vec3 across = v - glm::dot(v, axis) * axis;
  const double length = glm::length(across);
  return length > 1e-12 * glm::length(v) ? across / length : Frame(axis).tangent;
}

}  // namespace

BallPassage passageFrom(const Sphere& sphere, double ior, int inner, const Vec3& x, const Vec3& entry) {
  const Vec3 toCenter = sphere.center - x;
  const double distance = glm::length(toCenter);
  const Vec3 axis = toCenter / distance, d = entry - x, side = sideOf(d, axis);
  return makePassage(sphere, {distance, sphere.radius, ior, inner}, x, axis, side,
                     std::atan2(glm::dot(d, side), glm::dot(d, axis)));
}

BallPassages ballPassages(const Sphere& sphere, double ior, int inner, const Vec3& x, const LightPlace& light) {
  BallPassages result;
  const Vec3 toCenter = sphere.center - x;
  const double distance = glm::length(toCenter);
  if (distance <= sphere.radius) return result;
  if (!light.infinite && glm::length(light.at - sphere.center) <= sphere.radius) return result;
  const Vec3 axis = toCenter / distance, toLight = light.infinite ? light.at : light.at - x,
             side = sideOf(toLight, axis);
  const Vec2 flat(glm::dot(toLight, axis), glm::dot(toLight, side));
  const Course course{distance, sphere.radius, ior, inner};
  const Miss miss{course, light.infinite ? Vec2(std::atan2(flat.y, flat.x), 0.0) : flat, light.infinite};

  const double widest = std::asin(sphere.radius / distance) * (1.0 - 1e-12);
  std::array<double, kRootSteps + 1> at, value;
  for (int k = 0; k <= kRootSteps; ++k) {
    // Finer towards the rim, where the ray turns fastest; an even number of steps puts no sample on the axis itself.
    at[k] = widest * std::sin(0.5 * kPi * (2.0 * (k + 0.25) / (kRootSteps + 0.5) - 1.0));
    if (k == 0) at[k] = -widest;
    if (k == kRootSteps) at[k] = widest;
    value[k] = miss(at[k]);
  }
  const auto found = [&](double a, double fa, double b) {
    const BallPassage p = makePassage(sphere, course, x, axis, side, rootOfMiss(miss, a, fa, b));
    const bool ahead = light.infinite || glm::dot(light.at - p.exit, p.direction) > 0.0;
    if (ahead && result.count < static_cast<int>(result.list.size())) result.list[result.count++] = p;
  };
  // An angle's jump by 2 pi is no root; nor is the axis, where inner reflections turn by pi to either side.
  const auto joined = [&](int k) {
    if (inner > 0 && (at[k] > 0) != (at[k + 1] > 0)) return false;
    return !light.infinite || std::abs(value[k + 1] - value[k]) < kPi;
  };
  for (int k = 0; k < kRootSteps; ++k) {
    if ((value[k + 1] > 0) != (value[k] > 0)) {
      if (joined(k)) found(at[k], value[k], at[k + 1]);
      continue;
    }
    // Does a stretch without a change of sign reach across between two samples?
    if (k == 0 || (value[k - 1] > 0) != (value[k] > 0) || !joined(k) || !joined(k - 1)) continue;
    if (std::abs(value[k]) > std::abs(value[k - 1]) || std::abs(value[k]) > std::abs(value[k + 1])) continue;
    const double bottom = extremumOfMiss(miss, at[k - 1], at[k + 1], value[k] > 0 ? 1.0 : -1.0), low = miss(bottom);
    if ((low > 0) == (value[k] > 0)) continue;
    found(at[k - 1], value[k - 1], bottom);
    found(bottom, low, at[k + 1]);
  }
  return result;
}

double passageSpread(const Sphere& sphere, double ior, int inner, const Vec3& x, const BallPassage& p, double after) {
  const Vec3 toCenter = sphere.center - x;
  const double distance = glm::length(toCenter);
  const Vec3 axis = toCenter / distance, d = glm::normalize(p.entry - x), side = sideOf(d, axis);
  const double sinAlpha = std::max(glm::dot(d, side), 1e-12), cosAlpha = glm::dot(d, axis);
  const Bending b = bend({distance, sphere.radius, ior, inner}, std::atan2(sinAlpha, cosAlpha));
  // Around the axis the cone's offset from it stretches with sin alpha; in the plane the offset's derivative counts.
  if (std::isinf(after)) return std::abs(std::sin(b.turned) / sinAlpha * b.slope);
  const Vec3 end = p.exit + after * p.direction - x;
  const double u = glm::dot(end, axis) - distance, v = glm::dot(end, side);
  const double inPlane = -b.slope * (std::sin(b.turned) * v + std::cos(b.turned) * u) - distance * cosAlpha;
  return std::abs(v / sinAlpha * inPlane);
}

}  // namespace deltalux::rendering
