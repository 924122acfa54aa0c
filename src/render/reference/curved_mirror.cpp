#include "render/reference/curved_mirror.hpp"

#include <cmath>
#include <optional>

#include "base/check.hpp"
#include "base/tuning.hpp"

namespace deltalux::rendering {

namespace {

/// Between which roots are looked for.
constexpr int kRootSteps = deltalux::tuning::kPolarAngles;

/// A surface of revolution with straight generatrices: radius + slope z at height z over p0, 0 <= z <= height.
struct Revolution {
  Vec3 p0, axis;
  double height, radius, slope;
  bool inward;
};

std::optional<Revolution> revolution(const Shape& shape) {
  const auto make = [](const Vec3& p0, const Vec3& p1, double r0, double r1, bool inward) {
    const double height = glm::length(p1 - p0);
    return Revolution{p0, (p1 - p0) / height, height, r0, (r1 - r0) / height, inward};
  };
  if (const auto* c = std::get_if<Cylinder>(&shape)) return make(c->p0, c->p1, c->radius, c->radius, c->inward);
  if (const auto* c = std::get_if<Cone>(&shape)) return make(c->p0, c->p1, c->radius0, c->radius1, c->inward);
  return std::nullopt;
}

/// (Y.e - rhoY) (X.b) + (X.e - rhoX) (Y.b) with e = (cos, sin) of the azimuth and b = e': zero where the azimuth's
/// tangent plane mirrors X to Y on its own generatrix.
struct Condition {
  Vec2 X, Y;
  double rhoX, rhoY;

  double operator()(double phi) const { return value(std::cos(phi), std::sin(phi)); }
  double value(double c, double s) const {
    const double xe = X.x * c + X.y * s, xb = X.y * c - X.x * s;
    const double ye = Y.x * c + Y.y * s, yb = Y.y * c - Y.x * s;
    return (ye - rhoY) * xb + (xe - rhoX) * yb;
  }
};

/// Root between two azimuths whose values have opposite signs (Illinois' regula falsi).
double rootBetween(const Condition& f, double a, double fa, double b, double fb) {
  int side = 0;
  for (int i = 0; i < 60 && std::abs(b - a) > 1e-14; ++i) {
    const double m = (fa * b - fb * a) / (fa - fb), fm = f(m);
    if (fm == 0.0) return m;
    if ((fm > 0) == (fb > 0)) {
      b = m, fb = fm;
      if (side == -1) fa *= 0.5;
      side = -1;
    } else {
      a = m, fa = fm;
      if (side == 1) fb *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (a + b);
}

/// The extremum of f between two azimuths by golden sections, for a pair of roots that no sample separates.
double extremumBetween(const Condition& f, double a, double b, double sign) {
  constexpr double kGolden = 0.6180339887498949;  // [defined]
  for (int i = 0; i < 40; ++i) {
    const double left = b - kGolden * (b - a), right = a + kGolden * (b - a);
    (sign * f(left) < sign * f(right) ? b : a) = sign * f(left) < sign * f(right) ? right : left;
  }
  return 0.5 * (a + b);
}

struct Azimuths {
  std::array<double, 4> phi;
  int count = 0;
  void add(double p) {
    if (count < 4) phi[count++] = p;
  }
};

struct UnitCircle {
  std::array<double, kRootSteps> c, s;
  UnitCircle() {
    for (int i = 0; i < kRootSteps; ++i)
      c[i] = std::cos(2 * kPi * i / kRootSteps), s[i] = std::sin(2 * kPi * i / kRootSteps);
  }
};

Azimuths roots(const Condition& f) {
  static const UnitCircle circle;
  std::array<double, kRootSteps> values;
  for (int i = 0; i < kRootSteps; ++i) values[i] = f.value(circle.c[i], circle.s[i]);
  const auto at = [&](int i) { return values[(i + kRootSteps) % kRootSteps]; };
  constexpr double spacing = 2 * kPi / kRootSteps;
  Azimuths found;
  for (int i = 0; i < kRootSteps; ++i) {
    const double left = at(i), right = at(i + 1);
    if ((left > 0) != (right > 0)) {
      found.add(rootBetween(f, i * spacing, left, (i + 1) * spacing, right));
      continue;
    }
    // The value nearest to zero of a stretch without a change of sign: does it reach across in between?
    const bool dips =
        std::abs(left) < std::abs(at(i - 1)) && std::abs(left) <= std::abs(right) && (at(i - 1) > 0) == (left > 0);
    if (!dips) continue;
    const double sign = left > 0 ? 1.0 : -1.0;
    const double bottom = extremumBetween(f, (i - 1) * spacing, (i + 1) * spacing, sign), value = f(bottom);
    if (sign * value >= 0) continue;
    found.add(rootBetween(f, (i - 1) * spacing, at(i - 1), bottom, value));
    found.add(rootBetween(f, bottom, value, (i + 1) * spacing, right));
  }
  return found;
}

/// The mirror point on the plane through q with unit normal n, when both ends are on one side of it.
std::optional<Vec3> onPlane(const Vec3& q, const Vec3& n, const Vec3& x, const LightPlace& light, double& side) {
  const double hx = glm::dot(x - q, n);
  const double hy = light.infinite ? glm::dot(light.at, n) : glm::dot(light.at - q, n);
  if (!(hx * hy > 0.0)) return std::nullopt;
  side = hx;
  const Vec3 image = x - 2.0 * hx * n;
  return light.infinite ? image + hx / hy * light.at : image + hx / (hx + hy) * (light.at - image);
}

MirrorPoints onSphere(const Sphere& sphere, const Vec3& x, const LightPlace& light) {
  MirrorPoints result;
  const Vec3 toX = x - sphere.center, toY = light.infinite ? light.at : light.at - sphere.center;
  const double dx = glm::length(toX);
  if (!(dx > 0.0)) return result;
  const Vec3 e1 = toX / dx;
  const Vec3 across = toY - glm::dot(toY, e1) * e1;
  const double length = glm::length(across);
  const Vec3 e2 = length > 1e-12 * glm::length(toY) ? across / length : Frame(e1).tangent;
  const double rho = sphere.radius;
  const Azimuths azimuths = roots({{dx, 0.0}, {glm::dot(toY, e1), length}, rho, light.infinite ? 0.0 : rho});
  for (int i = 0; i < azimuths.count; ++i) {
    const Vec3 outward = std::cos(azimuths.phi[i]) * e1 + std::sin(azimuths.phi[i]) * e2;
    const Vec3 s = sphere.center + rho * outward;
    double side = 0;
    if (!onPlane(s, outward, x, light, side)) continue;
    const bool outside = side > 0.0;
    result.points[result.count++] = {s, outside ? outward : -outward, outside != sphere.inward};
  }
  return result;
}

MirrorPoints onRevolution(const Revolution& r, const Vec3& x, const LightPlace& light) {
  MirrorPoints result;
  const Frame frame(r.axis);
  const Vec3 toX = frame.toLocal(x - r.p0), toY = frame.toLocal(light.infinite ? light.at : light.at - r.p0);
  const double rhoX = r.radius + r.slope * toX.z;
  const double rhoY = light.infinite ? r.slope * toY.z : r.radius + r.slope * toY.z;
  const Azimuths azimuths = roots({{toX.x, toX.y}, {toY.x, toY.y}, rhoX, rhoY});
  for (int i = 0; i < azimuths.count; ++i) {
    const Vec3 e = std::cos(azimuths.phi[i]) * frame.tangent + std::sin(azimuths.phi[i]) * frame.bitangent;
    const Vec3 outward = glm::normalize(e - r.slope * r.axis);
    double side = 0;
    const auto s = onPlane(r.p0 + r.radius * e, outward, x, light, side);
    if (!s) continue;
    const double z = glm::dot(*s - r.p0, r.axis);
    // The plane also touches the mirror image of a cone beyond its tip, where the radius is negative.
    if (z < 0.0 || z > r.height || glm::dot(*s - r.p0, e) <= 0.0) continue;
    const bool outside = side > 0.0;
    result.points[result.count++] = {*s, outside ? outward : -outward, outside != r.inward};
  }
  return result;
}

/// Outward unit normal and principal curvatures (around: in direction `circumference`) of the shape at s.
struct LocalShape {
  Vec3 outward, circumference;
  double around, along;
};

LocalShape localShape(const Shape& shape, const Vec3& s) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const Vec3 outward = glm::normalize(s - sphere->center);
    return {outward, Frame(outward).tangent, 1.0 / sphere->radius, 1.0 / sphere->radius};
  }
  const auto r = revolution(shape);
  DELTALUX_CHECK(r.has_value(), "a sphere, cylinder or cone");
  const Vec3 fromAxis = (s - r->p0) - glm::dot(s - r->p0, r->axis) * r->axis;
  const double radius = glm::length(fromAxis);
  const Vec3 e = fromAxis / radius;
  return {glm::normalize(e - r->slope * r->axis), glm::cross(r->axis, e), 1.0 / (radius * std::hypot(1.0, r->slope)),
          0.0};
}

}  // namespace

bool isCurvedMirror(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || revolution(shape).has_value();
}

MirrorPoints mirrorPoints(const Shape& shape, const Vec3& x, const LightPlace& light) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return onSphere(*sphere, x, light);
  const auto r = revolution(shape);
  return r ? onRevolution(*r, x, light) : MirrorPoints{};
}

double reflectedSpread(const Shape& shape, const Vec3& x, const Vec3& s, double after) {
  const LocalShape local = localShape(shape, s);
  const double before = glm::length(s - x);
  const Vec3 d = (s - x) / before;
  const double cosOutward = -glm::dot(d, local.outward), cosine = std::abs(cosOutward);
  const double sign = cosOutward > 0.0 ? 1.0 : -1.0;  // from inside, the surface is hollow
  const Vec3 n = sign * local.outward;
  const Vec3 inPlane = d + cosine * n;
  const double length = glm::length(inPlane);
  const Vec3 t1 = length > 1e-9 ? inPlane / length : Frame(n).tangent, t2 = glm::cross(n, t1);
  const double b1 = glm::dot(local.circumference, t1), b2 = glm::dot(local.circumference, t2);
  const double s11 = sign * (local.around * b1 * b1 + local.along * b2 * b2);
  const double s22 = sign * (local.around * b2 * b2 + local.along * b1 * b1);
  const double s12 = sign * (local.around - local.along) * b1 * b2;
  // Curvature of the reflected wavefront: the sphere around x, bent twice by the surface as the beam sees it.
  const double q11 = 1.0 / before + 2.0 * s11 / cosine, q22 = 1.0 / before + 2.0 * s22 * cosine, q12 = 2.0 * s12;
  const double determinant =
      std::isinf(after) ? q11 * q22 - q12 * q12 : (1.0 + after * q11) * (1.0 + after * q22) - after * after * q12 * q12;
  return before * before * std::abs(determinant);
}

}  // namespace deltalux::rendering
