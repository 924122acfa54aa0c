// Caustics of a lamp by way of a mirror, a polished or glass ball and both, against a plain recursive ray tracer that
// splits at every surface and integrates over all directions of the meter.
#include <gtest/gtest.h>

#include <deltalux/reference.hpp>

#include "base/sobol.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr double kGlass = 1.5, kMirror = 0.8, kMetal = 0.9, kRadiance = 3.0;

struct Arrangement {
  Sphere ball{{0.3, 0.1, 0.9}, 0.4};
  Ring lamp{{0.6, 0.3, 2.2}, glm::normalize(Vec3(-0.2, -0.1, -1)), 0, 0.15};
  double mirror = -0.8;  // plane x = mirror, facing +x
  bool glass = true;
};

/// Radiance that comes back along a ray, followed through at most `depth` surfaces.
double seen(const Arrangement& s, const Vec3& o, const Vec3& d, bool inside, int depth, double weight) {
  if (depth == 0 || weight < 1e-5) return 0;
  const Vec3 toCenter = s.ball.center - o;
  const double b = glm::dot(toCenter, d), q = s.ball.radius * s.ball.radius - glm::dot(toCenter, toCenter) + b * b;
  double ball = q > 0 ? (inside ? b + std::sqrt(q) : b - std::sqrt(q)) : -1;
  if (ball < 1e-7) ball = kInfinity;
  double mirror = inside || d.x >= 0 ? kInfinity : (s.mirror - o.x) / d.x;
  if (mirror < 1e-7) mirror = kInfinity;
  const double slope = glm::dot(d, s.lamp.normal);
  double lamp = inside ? kInfinity : glm::dot(s.lamp.center - o, s.lamp.normal) / slope;
  if (lamp < 1e-7 || glm::length(o + lamp * d - s.lamp.center) > s.lamp.outerRadius) lamp = kInfinity;
  const double t = std::min({ball, mirror, lamp});
  if (std::isinf(t)) return 0;
  if (t == lamp) return slope < 0 ? weight * kRadiance : 0;
  const Vec3 p = o + t * d;
  if (t == mirror) return seen(s, p, {-d.x, d.y, d.z}, false, depth - 1, weight * kMirror);
  const Vec3 n = (p - s.ball.center) / s.ball.radius * (inside ? -1.0 : 1.0);
  const double c = -glm::dot(d, n), eta = inside ? kGlass : 1 / kGlass;
  const Vec3 reflected = d + 2 * c * n;
  if (!s.glass) return seen(s, p, reflected, false, depth - 1, weight * kMetal);
  const double F = fresnelDielectric(c, 1 / eta), under = 1 - eta * eta * (1 - c * c);
  double sum = seen(s, p, reflected, inside, depth - 1, weight * F);
  if (under > 0) sum += seen(s, p, eta * d + (eta * c - std::sqrt(under)) * n, !inside, depth - 1, weight * (1 - F));
  return sum;
}

double irradianceByRayTracing(const Arrangement& s) {
  constexpr std::uint32_t n = 1u << 22;
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const UnitPair u = scrambledSobol(i, 7);
    const double r = std::sqrt(u.x), phi = 2 * kPi * u.y;
    sum += seen(s, Vec3(0), {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)}, false, 9, 1.0);
  }
  return kPi * sum / n;
}

void expectSame(const Arrangement& s) {
  Scene scene;
  Opaque polished;
  polished.specular.reflectance = Rgb(static_cast<float>(kMetal));
  addShape(scene,
           s.glass ? addMaterial(scene, "glass", Dielectric{Rgb(1.0f), kGlass}) : addMaterial(scene, "metal", polished),
           s.ball);
  addShape(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(kRadiance), false, {}}), s.lamp);
  const double x = s.mirror;
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(static_cast<float>(kMirror))}),
             {{x, -3, -3}, {x, 3, -3}, {x, 3, 3}, {x, -3, 3}});
  ReferenceSettings settings;
  settings.samples = 65536;  // ways over three bends are rare bright samples
  const ProbeResult r = ReferenceIntegrator(scene, settings).probe(std::vector<ProbePoint>{{Vec3(0), {0, 0, 1}}})[0];
  const double expected = irradianceByRayTracing(s);
  EXPECT_NEAR(r.irradiance.g, expected, 4 * r.standardError.g + 0.01 * expected);
  EXPECT_LT(r.standardError.g, 0.025 * expected);
}

TEST(ReferenceCaustic, PolishedBallAndMirror) { expectSame({.glass = false}); }
TEST(ReferenceCaustic, GlassBallAndMirror) { expectSame({}); }

TEST(ReferenceCaustic, LampBehindTheBall) {
  Arrangement s;
  s.lamp.center = {0.75, 0.25, 2.2};  // hidden: all light comes by way of the ball or the mirror
  s.lamp.normal = glm::normalize(Vec3(-0.3, -0.1, -1));
  s.ball = Sphere{{0.35, 0.12, 1.0}, 0.45};
  expectSame(s);
}

}  // namespace
}  // namespace deltalux
