// Every light's sampler draws from its density, and the irradiance it gives is the known one.
#include "scene/light_sampling.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "scene/light_sampling_triangle.hpp"
#include "stats/chi_square.hpp"
#include "stats/t_test.hpp"

namespace deltalux {
using namespace scene;

namespace {

constexpr double kSignificance = 1e-4;

Scene lit(Shape shape, Emission emission = {Rgb(3.0f), false, {}}) {
  Scene scene;
  scene.materials.push_back({"lamp", Opaque{}, emission});
  scene.primitives.push_back({std::move(shape), MaterialId(0), ObjectId(0)});
  scene.lights.push_back({"lamp", AreaLight{PrimitiveId(0)}, Rgb(1.0f)});
  return scene;
}

Scene lit(decltype(Light::emitter) emitter) {
  Scene scene;
  scene.lights.push_back({"lamp", std::move(emitter), Rgb(1.0f)});
  return scene;
}

Polygon square(double side) {
  const double h = side / 2;
  return *makePolygon({{-h, -h, 2}, {-h, h, 2}, {h, h, 2}, {h, -h, 2}});  // faces down
}

/// Irradiance at `from` with `normal`, by the sampler alone.
test::Moments irradiance(const Scene& scene, const Vec3& from, const Vec3& normal, int samples = 100000) {
  const LightSampler sampler(scene);
  Rng rng(77);
  test::Moments E;
  for (int i = 0; i < samples; ++i) {
    const auto s = sampler.sample(LightId(0), from, {rng.uniform(), rng.uniform()});
    const double cosine = s ? std::max(0.0, glm::dot(s->direction, normal)) : 0.0;
    E.add(s ? s->radiance.r * cosine / (s->pdf > 0 ? s->pdf : 1.0) : 0.0);
  }
  return E;
}

/// Chi-square of sample() against pdf(); `meet` finds where a direction meets the light (distance, normal).
template <class Meet>
void expectSamplesFollowDensity(const Scene& scene, const Vec3& from, const Vec3& axis, double concentration,
                                const Meet& meet, bool round = false) {
  const LightSampler sampler(scene);
  const auto draw = [&](const Vec3& u) -> std::optional<Vec3> {
    const auto s = sampler.sample(LightId(0), from, {u.x, u.y});
    if (!s) return std::nullopt;
    EXPECT_NEAR(glm::length(s->direction), 1.0, 1e-9);
    return s->direction;
  };
  const auto density = [&](const Vec3& w) {
    const std::optional<std::pair<double, Vec3>> hit = meet(w);
    return hit ? sampler.pdf(LightId(0), from, w, hit->first, hit->second) : 0.0;
  };
  test::DirectionTest around{axis, concentration};
  // The edge of a round light runs along a ring: only rings need to be fine there.
  around.ringSubdivisions = round ? 2000 : 24, around.sectorSubdivisions = round ? 1 : 24;
  const auto result = test::chiSquareDirections(draw, density, around);
  EXPECT_GT(result.pValue, kSignificance) << result.message;
  for (int i = 0; i < 200; ++i) {  // the sample's own density is what pdf() says
    Rng rng(i);
    const auto s = sampler.sample(LightId(0), from, {rng.uniform(), rng.uniform()});
    if (!s) continue;
    EXPECT_NEAR(sampler.pdf(LightId(0), from, s->direction, s->distance, s->normal) / s->pdf, 1.0, 1e-6);
  }
}

auto meetSquare(double side, const Vec3& from) {
  return [=](const Vec3& w) -> std::optional<std::pair<double, Vec3>> {
    if (w.z <= 0) return std::nullopt;
    const double t = (2 - from.z) / w.z;
    const Vec3 p = from + t * w;
    if (std::abs(p.x) > side / 2 || std::abs(p.y) > side / 2) return std::nullopt;
    return std::pair(t, Vec3(0, 0, -1));
  };
}

TEST(LightSampling, PolygonsFollowTheirDensity) {
  const Vec3 near(0.3, 0.2, 1.0), far(0.3, 0.2, -60);  // by solid angle, by area
  expectSamplesFollowDensity(lit(square(2)), near, glm::normalize(Vec3(-0.3, -0.2, 1)), 1, meetSquare(2, near));
  expectSamplesFollowDensity(lit(square(2)), far, glm::normalize(Vec3(-0.3, -0.2, 62)), 12, meetSquare(2, far));
}

TEST(LightSampling, SpheresFollowTheirDensity) {
  for (const Vec3 from : {Vec3(0, 0, 1.2), Vec3(5, 1, 0)}) {
    const auto meet = [&](const Vec3& w) -> std::optional<std::pair<double, Vec3>> {
      const double b = -glm::dot(from, w), inside = 1 - (glm::dot(from, from) - b * b);
      if (b < 0 || inside < 0) return std::nullopt;
      const double t = b - std::sqrt(inside);
      return std::pair(t, from + t * w);
    };
    expectSamplesFollowDensity(lit(Sphere{}), from, -glm::normalize(from), from.z > 1 ? 2 : 6, meet, true);
  }
  const Vec3 within(0.5, 0.2, 0);
  const auto meet = [&](const Vec3& w) {
    const double b = -glm::dot(within, w), t = b + std::sqrt(1 - glm::dot(within, within) + b * b);
    return std::optional(std::pair(t, -(within + t * w)));
  };
  expectSamplesFollowDensity(lit(Sphere{Vec3(0), 1, true}), within, Vec3(0, 0, 1), 1, meet);
}

TEST(LightSampling, SkyFollowsItsDensity) {
  const CieSky clear{12, 1, 0.2, glm::normalize(Vec3(1, 1, 1))};
  for (double halfAngle : {kPi / 2, kPi}) {
    const Scene scene = lit(DomeLight{{0, 0, 1}, halfAngle, Rgb(1.0f), clear, {0, 0, 1}});
    // Multiples of the table's rings and sectors, so that no bin cuts a cell.
    const LightSampler sampler(scene);
    test::DirectionTest around;
    around.rings = 64, around.sectors = 64, around.ringSubdivisions = around.sectorSubdivisions = 2,
    around.samples = 400000;
    const auto draw = [&](const Vec3& u) {
      return std::optional(sampler.sample(LightId(0), Vec3(0), {u.x, u.y})->direction);
    };
    const auto density = [&](const Vec3& w) { return sampler.pdf(LightId(0), Vec3(0), w, 0, {}); };
    const auto result = test::chiSquareDirections(draw, density, around);
    EXPECT_GT(result.pValue, kSignificance) << result.message;
  }
}

TEST(LightSampling, SunFollowsItsDensity) {
  const SunLight sun{glm::normalize(Vec3(1, 2, 3)), 0.02, Rgb(5.0f)};
  const Scene scene = lit(sun);
  const LightSampler sampler(scene);
  const auto meet = [&](const Vec3& w) {
    return sampler.radianceFrom(LightId(0), w).r > 0 ? std::optional(std::pair(0.0, Vec3(0))) : std::nullopt;
  };
  expectSamplesFollowDensity(scene, Vec3(0), sun.direction, 12, meet, true);
  EXPECT_NEAR(irradiance(scene, Vec3(0), sun.direction).mean(), 5 * kPi * std::pow(std::sin(0.02), 2), 1e-6);
}

// Exact irradiances: a parallel square by the configuration factor of its quarter, a sphere by its solid angle.
TEST(LightSampling, IrradianceOfAParallelSquare) {
  for (double below : {0.05, 2.0, 40.0}) {
    const double a = 1 / below;
    const double quarter = 2 * a / std::sqrt(1 + a * a) * std::atan(a / std::sqrt(1 + a * a)) / (2 * kPi);
    const test::Moments E = irradiance(lit(square(2)), {0, 0, 2 - below}, {0, 0, 1});
    EXPECT_NEAR(E.mean(), 4 * quarter * kPi * 3, 5 * E.standardError() + 1e-6 * E.mean()) << below;
  }
}

TEST(LightSampling, IrradianceOfCurvedLamps) {
  const test::Moments sphere = irradiance(lit(Sphere{{0, 0, 4}, 1}), Vec3(0), {0, 0, 1});
  EXPECT_NEAR(sphere.mean(), 3 * kPi / 16, 1e-4);
  const test::Moments disc = irradiance(lit(Ring{{0, 0, 4}, {0, 0, -1}, 0, 1}), Vec3(0), {0, 0, 1});
  EXPECT_NEAR(disc.mean(), 3 * kPi / 17, 5 * disc.standardError());
  // Infinite cylinder seen from distance 4: half width asin(1/4) in one plane, E = pi L r / d; this one is very long.
  const test::Moments tube = irradiance(lit(Cylinder{{-2000, 0, 4}, {2000, 0, 4}, 1}), Vec3(0), {0, 0, 1}, 4000000);
  EXPECT_NEAR(tube.mean(), 3 * kPi / 4, 5 * tube.standardError());
}

TEST(LightSampling, ClosedFormsAreWhatSamplesAre) {
  const Vec3 tilted = glm::normalize(Vec3(1, -0.5, 1.5));
  for (const Scene& scene : {lit(square(1)), lit(square(1), {Rgb(3.0f), true, {}}), lit(Sphere{{0.3, 0, 2}, 0.4})})
    for (const auto& [from, normal] :
         {std::pair(Vec3(0), Vec3(0, 0, 1)), std::pair(Vec3(0.7, 0.2, 0.5), tilted),
          std::pair(Vec3(3, -2, 1.2), Vec3(0, 0, 1)), std::pair(Vec3(0, 0, 5), Vec3(0, 0, -1)),
          std::pair(Vec3(1, 0, 1.8), Vec3(-1, 0, 0))}) {
      const auto exact = LightSampler(scene).irradiance(LightId(0), from, normal);
      const test::Moments sampled = irradiance(scene, from, normal);
      ASSERT_TRUE(exact || std::holds_alternative<Sphere>(scene.primitives[0].shape));
      if (!exact) continue;
      EXPECT_NEAR(exact->r, sampled.mean(), 5 * sampled.standardError() + 1e-6) << from.x << " " << from.z;
    }
  // Part of it below the horizon, from inside, a cone: none is known.
  const Scene sphere = lit(Sphere{{0, 0, 0.1}, 0.4});
  EXPECT_FALSE(LightSampler(sphere).irradiance(LightId(0), {2, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(LightSampler(sphere).irradiance(LightId(0), {0, 0, 0}, {0, 0, 1}));
  const Scene spot = lit(square(1), {Rgb(3.0f), false, SpotCone{0.5, {0, 0, -1}}});
  EXPECT_FALSE(LightSampler(spot).irradiance(LightId(0), Vec3(0), {0, 0, 1}));
}

TEST(LightSampling, TrianglesOfAMeshByArea) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const test::Moments asMesh = irradiance(lit(mesh), {0.2, 0, 0}, {0, 0, 1});
  const test::Moments asPolygon = irradiance(lit(square(2)), {0.2, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(asMesh.mean(), asPolygon.mean(), 5 * asMesh.standardError());
}

TEST(LightSampling, SpotlightRule) {
  // A small spotlight of area A at distance d on axis: E = L A / (d + |direction|)^2; nothing outside the cone.
  const double radius = 0.01, A = kPi * radius * radius;
  const Scene scene =
      lit(Ring{{0, 0, 5}, {0, 0, -1}, 0, radius}, {Rgb(100.0f), false, SpotCone{40 * kPi / 180, {0, 0, -1.5}}});
  EXPECT_NEAR(irradiance(scene, Vec3(0), {0, 0, 1}).mean(), 100 * A / std::pow(5 + 1.5, 2), 1e-6);
  EXPECT_EQ(irradiance(scene, {5 * std::tan(21 * kPi / 180), 0, 0}, {0, 0, 1}).mean(), 0.0);
  EXPECT_GT(irradiance(scene, {5 * std::tan(19 * kPi / 180), 0, 0}, {0, 0, 1}).mean(), 0.0);
}

TEST(LightSampling, PointsAndDimming) {
  Scene scene = lit(PointLight{{0, 0, 2}, Rgb(8.0f)});
  scene.lights[0].scale = Rgb(0.5f);
  EXPECT_NEAR(irradiance(scene, Vec3(0), {0, 0, 1}, 10).mean(), 1.0, 1e-9);
  EXPECT_TRUE(LightSampler(scene).isPointLike(LightId(0)));
}

TEST(LightSampling, FrontAloneShinesUnlessBothSides) {
  EXPECT_EQ(irradiance(lit(square(2)), {0, 0, 3}, {0, 0, -1}).mean(), 0.0);
  EXPECT_GT(irradiance(lit(square(2), {Rgb(3.0f), true, {}}), {0, 0, 3}, {0, 0, -1}).mean(), 0.0);
}

}  // namespace
}  // namespace deltalux
