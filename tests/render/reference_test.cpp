// Properties of the reference integrator: furnaces, linearity, the same result for any thread count, known caustics.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/reference.hpp>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "stats/t_test.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

ReferenceSettings withSamples(std::uint64_t samples) {
  ReferenceSettings settings;
  settings.samples = samples;
  return settings;
}

std::vector<ProbeResult> measure(const Scene& scene, const std::vector<ProbePoint>& points, std::uint64_t samples) {
  return ReferenceIntegrator(scene, withSamples(samples)).probe(points);
}

/// No more than `tolerance` or four standard errors off; and the standard errors are small enough to mean something.
void expectIrradiance(const ProbeResult& r, double expected, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(r.irradiance[i], expected, std::max(4.5 * r.standardError[i], 1e-5 * expected));
    EXPECT_LT(r.standardError[i], tolerance * expected);
  }
}

Scene furnace(float rho, float exitance) {
  Scene scene;
  const Emission emission{Rgb(exitance / static_cast<float>(kPi)), false, {}};
  addBox(scene, addMaterial(scene, "wall", lambert(rho), emission), Vec3(0), Vec3(1), true);
  return scene;
}

const std::vector<ProbePoint> kFurnacePoints = {{{0.5, 0.5, 0}, {0, 0, 1}},
                                                {{0.01, 0.02, 0}, {0, 0, 1}},
                                                {{1, 0.3, 0.6}, {-1, 0, 0}},
                                                {{0.3, 0.4, 0.35}, glm::normalize(Vec3(1, 1, 1))}};

TEST(ReferenceFurnace, ClosedBoxHasOneIrradianceEverywhere) {
  for (float rho : {0.1f, 0.5f, 0.9f}) {
    for (const ProbeResult& r : measure(furnace(rho, 2), kFurnacePoints, 4096))
      expectIrradiance(r, 2 / (1 - rho), rho > 0.8f ? 0.03 : 0.01);
  }
}

TEST(ReferenceFurnace, StaysOneWithMirrorsAndGlassInside) {
  Scene scene = furnace(0.5f, 2);
  Opaque polished;
  polished.specular.reflectance = Rgb(1.0f);
  addBox(scene, addMaterial(scene, "mirror", Mirror{Rgb(1.0f)}), Vec3(0.6, 0.1, 0.1), Vec3(0.8, 0.3, 0.5), false);
  addShape(scene, addMaterial(scene, "metal", polished), Sphere{{0.2, 0.7, 0.3}, 0.15});
  addShape(scene, MaterialId(2), Cylinder{{0.6, 0.6, 0.1}, {0.7, 0.7, 0.3}, 0.1});
  addShape(scene, addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{0.7, 0.75, 0.7}, 0.15});
  addPolygon(scene, addMaterial(scene, "pane", ThinGlass{}),
             {{0.1, 0.1, 0.8}, {0.5, 0.1, 0.8}, {0.5, 0.5, 0.8}, {0.1, 0.5, 0.8}});
  for (const ProbeResult& r : measure(scene, kFurnacePoints, 4096)) expectIrradiance(r, 4, 0.02);
}

TEST(ReferenceFurnace, SkyOfRadianceOne) {
  Scene scene;
  addShape(scene, addMaterial(scene, "white", lambert(1.0f)), Sphere{{0, 0, -3}, 1});
  addLight(scene, DomeLight{{0, 0, 1}, kPi, Rgb(1.0f), UniformSky{1}, {0, 0, 1}});
  // A white ball in a uniform world is invisible to a light meter.
  for (const ProbeResult& r : measure(scene, {{{0, 0, -1.5}, {0, 0, -1}}, {{0, 0, -2}, {0, 0, 1}}}, 4096))
    expectIrradiance(r, kPi, 0.01);
}

Scene litRoom() {
  Scene scene;
  addBox(scene,
         addMaterial(scene, "wall",
                     Opaque{.diffuse = Rgb(0.7f, 0.5f, 0.2f), .diffuseTexture = {}, .specular = {Rgb(0.1f), 0.1f, {}}}),
         Vec3(0), Vec3(2), true);
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0), Emission{Rgb(5.0f, 4.0f, 3.0f), false, {}});
  addPolygon(scene, lamp, {{0.8, 0.8, 1.99}, {0.8, 1.2, 1.99}, {1.2, 1.2, 1.99}, {1.2, 0.8, 1.99}});
  addShape(scene, lamp, Sphere{{0.3, 1.5, 0.5}, 0.1});
  addBox(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}), Vec3(1.2, 0.3, 0.2), Vec3(1.6, 0.6, 0.9), false);
  addShape(scene, addMaterial(scene, "glass", Dielectric{Rgb(0.9f, 0.8f, 0.9f), 1.5f}), Sphere{{0.7, 0.7, 0.5}, 0.2});
  return scene;
}

const std::vector<ProbePoint> kRoomPoints = {
    {{1, 1, 0}, {0, 0, 1}}, {{0, 1, 1}, {1, 0, 0}}, {{1.5, 1.8, 2}, {0, 0, -1}}};

TEST(Reference, SameBitsForAnyThreadCount) {
  const auto run = [](std::size_t threads) {
    const ThreadLimit limit(threads);
    return measure(litRoom(), kRoomPoints, 500);
  };
  const auto one = run(1), two = run(2), four = run(4);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].irradiance, two[i].irradiance);
    EXPECT_EQ(one[i].standardError, two[i].standardError);
    EXPECT_EQ(one[i].irradiance, four[i].irradiance);
    EXPECT_GE(one[i].samples, 500u);
  }
}

TEST(Reference, LinearInTheLights) {
  Scene twice = litRoom();
  for (Material& m : twice.materials) {
    if (m.emission) m.emission->radiance *= 2.0f;
  }
  const auto one = measure(litRoom(), kRoomPoints, 512), two = measure(twice, kRoomPoints, 512);
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(two[i].irradiance[c] / one[i].irradiance[c], 2.0, 1e-4);
  }
}

TEST(Reference, LightsAddUp) {
  const auto dimmed = [](int keep) {
    Scene scene = litRoom();
    addAreaLights(scene);
    for (int i = 0; i < 2; ++i) {
      if (keep >= 0 && i != keep) scene.lights[i].scale = Rgb(0.0f);
    }
    return measure(scene, kRoomPoints, 8192);
  };
  const auto both = dimmed(-1), first = dimmed(0), second = dimmed(1);
  for (std::size_t i = 0; i < both.size(); ++i) {
    const glm::dvec3 difference = both[i].irradiance - first[i].irradiance - second[i].irradiance;
    const glm::dvec3 error =
        glm::sqrt(both[i].standardError * both[i].standardError + first[i].standardError * first[i].standardError +
                  second[i].standardError * second[i].standardError);
    for (int c = 0; c < 3; ++c) EXPECT_LT(std::abs(difference[c]), 4.5 * error[c]);
  }
}

TEST(Reference, OtherSeedsAgreeWithinTheirErrors) {
  Moments z;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    ReferenceSettings a = withSamples(256), b = withSamples(256);
    a.seed = 2 * seed, b.seed = 2 * seed + 1;
    const auto x = ReferenceIntegrator(litRoom(), a).probe(kRoomPoints),
               y = ReferenceIntegrator(litRoom(), b).probe(kRoomPoints);
    for (std::size_t i = 0; i < x.size(); ++i) {
      z.add((x[i].irradiance.g - y[i].irradiance.g) / std::hypot(x[i].standardError.g, y[i].standardError.g));
    }
  }
  EXPECT_LT(std::abs(z.mean()), 0.4);
  EXPECT_GT(z.variance(), 0.5);
  EXPECT_LT(z.variance(), 1.8);  // sixteen or fewer batches: Student's tails
}

TEST(Reference, DiffuseOnlyDropsMirrorsAndKeepsPanes) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(1.0f)}), {{1, -5, -5}, {1, -5, 5}, {1, 5, 5}, {1, 5, -5}});
  addPolygon(scene, addMaterial(scene, "pane", ThinGlass{}), {{-5, -5, 1}, {5, -5, 1}, {5, 5, 1}, {-5, 5, 1}});
  addLight(scene, PointLight{{0, 0, 2}, Rgb(4.0f)});
  ReferenceSettings settings = withSamples(1024);
  settings.diffuseOnly = true;
  const double pane = transmittance(ThinGlass{}, 1.0).g;
  expectIrradiance(ReferenceIntegrator(scene, settings).probe(std::vector<ProbePoint>{{Vec3(0), {0, 0, 1}}})[0], pane,
                   0.01);
}

// The mirror x = 1 shows the light at (2, 0, 2): its image adds I cos / d^2, through the pane at its own angle.
TEST(ReferenceMirror, ImageOfAPointLight) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.8f)}), {{1, -5, -5}, {1, -5, 5}, {1, 5, 5}, {1, 5, -5}});
  addLight(scene, PointLight{{0, 0, 2}, Rgb(4.0f)});
  const ProbeResult r = measure(scene, {{Vec3(0), {0, 0, 1}}}, 4096)[0];
  expectIrradiance(r, 1 + 0.8 * 4 * (2 / std::sqrt(8.0)) / 8, 0.03);
}

TEST(ReferenceMirror, ImagesOfSunAndLampAreCountedOnce) {
  for (bool sunny : {true, false}) {
    Scene scene;
    Opaque polished;
    polished.specular.reflectance = Rgb(0.8f);
    addPolygon(scene, addMaterial(scene, "metal", polished), {{1, -9, -9}, {1, -9, 9}, {1, 9, 9}, {1, 9, -9}});
    double expected = 0;
    if (sunny) {
      // The meter looks at the mirror and away from the sun.
      const SunLight sun{glm::normalize(Vec3(-1, 0, 0.5)), 0.05, Rgb(10.0f)};
      addLight(scene, sun);
      expected = 0.8 * 10 * kPi * std::pow(std::sin(sun.angularRadius), 2) * -sun.direction.x;
    } else {
      // A ball beside the meter's back, seen in the mirror only, at (4, 0, 0.5): E = pi L cos r^2 / d^2.
      addShape(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(3.0f), false, {}}),
               Sphere{{-2, 0, 0.5}, 0.4});
      expected = 0.8 * 3 * kPi * 0.16 / 16.25 * 4 / std::sqrt(16.25);
    }
    expectIrradiance(measure(scene, {{Vec3(0), {1, 0, 0}}}, 8192)[0], expected, 0.02);
  }
}

/// Irradiance that a meter at the origin, facing up, gets from a round lamp by way of a mirroring ball: plain
/// quadrature over the directions that meet the ball.
double byWayOfBall(const Sphere& ball, const Ring& lamp, double radiance) {
  const double d = glm::length(ball.center), depth = 1 - std::sqrt(1 - ball.radius * ball.radius / (d * d));
  const Frame frame(ball.center / d);
  constexpr int n = 3000;
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const double down = (i % n + 0.5) / n * depth, radius = std::sqrt(down * (2 - down)),
                 phi = 2 * kPi * (i / n + 0.5) / n;
    const Vec3 w = frame.toWorld({radius * std::cos(phi), radius * std::sin(phi), 1 - down});
    if (w.z <= 0) continue;
    const double along = glm::dot(ball.center, w);
    const double t = along - std::sqrt(std::max(0.0, ball.radius * ball.radius - d * d + along * along));
    const Vec3 s = t * w, normal = (s - ball.center) / ball.radius, r = w - 2 * glm::dot(w, normal) * normal;
    const double slope = glm::dot(r, lamp.normal);
    if (slope >= 0) continue;
    const Vec3 on = s + glm::dot(lamp.center - s, lamp.normal) / slope * r;
    if (glm::dot(on - s, r) > 0 && glm::length(on - lamp.center) < lamp.outerRadius) sum += w.z;
  }
  return radiance * sum / n / n * 2 * kPi * depth;
}

TEST(ReferenceMirror, LampsOverCurvedMirrors) {
  const Sphere ball{{0.4, 0.2, 1.0}, 0.3};
  for (double size : {0.05, 0.6}) {  // small: by connections; large: by scattering too
    Scene scene;
    Opaque polished;
    polished.specular.reflectance = Rgb(0.9f);
    addShape(scene, addMaterial(scene, "metal", polished), ball);
    const Ring lamp{{1.5, -0.5, -0.5}, glm::normalize(Vec3(-1, 0.6, 1.2)), 0, size};  // below the meter's horizon
    addShape(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(3.0f), false, {}}), lamp);
    const ProbeResult r = measure(scene, {{Vec3(0), {0, 0, 1}}}, 16384)[0];
    const double expected = 0.9 * byWayOfBall(ball, lamp, 3);
    EXPECT_NEAR(r.irradiance.g, expected, 4.5 * r.standardError.g + 0.007 * expected);  // the quadrature's own error
    EXPECT_LT(r.standardError.g, 0.02 * expected);
  }
}

TEST(ReferenceMirror, SunAndPointOverABall) {
  // Far from a ball of radius a: E = R E_sun a^2 / (4 d^2), whatever the angle; a far point light is a sun.
  for (bool sunny : {true, false}) {
    Scene scene;
    Opaque polished;
    polished.specular.reflectance = Rgb(0.9f);
    addShape(scene, addMaterial(scene, "metal", polished), Sphere{{0, 0, 100}, 0.5});
    const SunLight sun{glm::normalize(Vec3(1, 0, -0.2)), 0.004, Rgb(1e6f)};
    if (sunny) addLight(scene, sun);
    if (!sunny)
      addLight(scene, PointLight{Vec3(0, 0, 100) + 1e4 * sun.direction,
                                 Rgb(1e6f * 1e8f * static_cast<float>(solidAngle(sun)))});
    const double expected = 0.9 * 1e6 * solidAngle(sun) * 0.25 / (4 * 1e4);
    for (const ProbeResult& r : measure(scene, {{Vec3(0), {0, 0, 1}}}, 1024)) {
      EXPECT_NEAR(r.irradiance.g / expected, 1.0, 0.02);  // the ball is not infinitely far
      EXPECT_LT(r.standardError.g, 0.02 * expected);
    }
  }
}

TEST(ReferenceRender, PixelsShowWhatStandsThere) {
  Scene scene = furnace(0.5f, static_cast<float>(kPi));
  View view;
  view.position = Vec3(0.5), view.direction = {1, 0.2, 0.1}, view.horizontal = view.vertical = 60;
  ReferenceIntegrator integrator(scene, withSamples(256));
  const Image image = integrator.render(view, 8, 6);
  ASSERT_EQ(image.pixels.size(), 48u);
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += p.g;
  EXPECT_NEAR(sum / 48, 2.0, 0.02);
  EXPECT_EQ(integrator.stats().paths, 48u * 256u);
  EXPECT_GT(integrator.stats().rays, integrator.stats().paths);
}

TEST(ReferenceRender, TopRowLooksUp) {
  Scene scene;
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(1.0f), UniformSky{1}, {0, 0, 1}});
  View view;
  view.direction = {0, 1, 0}, view.horizontal = view.vertical = 60;
  const Image image = ReferenceIntegrator(scene, withSamples(16)).render(view, 2, 4);
  for (int x = 0; x < 2; ++x) {
    EXPECT_EQ(image.at(x, 0), Rgb(1.0f));
    EXPECT_EQ(image.at(x, 3), Rgb(0.0f));
  }
}

TEST(Reference, SecondsLimitTheWork) {
  ReferenceSettings settings;
  settings.samples = 0, settings.seconds = 0.3;
  ReferenceIntegrator integrator(litRoom(), settings);
  const auto results = integrator.probe(kRoomPoints);
  EXPECT_LT(integrator.stats().seconds, 2.0);
  for (const ProbeResult& r : results) {
    EXPECT_EQ(r.samples, results[0].samples);
    EXPECT_GT(r.samples, 0u);
    EXPECT_GT(r.standardError.g, 0.0);
  }
}

TEST(Reference, TargetErrorStopsThePoints) {
  ReferenceSettings settings = withSamples(1 << 20);
  settings.targetError = 0.02;
  for (const ProbeResult& r : ReferenceIntegrator(litRoom(), settings).probe(kRoomPoints)) {
    EXPECT_LT(r.samples, 1u << 20);
    for (int c = 0; c < 3; ++c) EXPECT_LE(r.standardError[c], 0.02 * r.irradiance[c]);
  }
}

class StopAfter : public Progress {
 public:
  explicit StopAfter(int reports) : left_(reports) {}
  void report(std::string_view, double fraction) override {
    EXPECT_GE(fraction, last_ - 1e-9);
    EXPECT_LE(fraction, 1.0);
    last_ = fraction, --left_;
  }
  bool stopRequested() const override { return left_ <= 0; }

 private:
  int left_;
  double last_ = 0;
};

TEST(Reference, StopsWhenAsked) {
  StopAfter stop(3);
  ReferenceIntegrator integrator(litRoom(), withSamples(1 << 20));
  EXPECT_THROW(integrator.probe(kRoomPoints, &stop), Interrupted);
  EXPECT_LT(integrator.stats().paths, 1u << 20);
}

}  // namespace
}  // namespace deltalux
