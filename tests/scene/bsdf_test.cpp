// Samplers draw from their densities (chi-square); lobes are reciprocal and never reflect more than they get.
#include "scene/bsdf.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "stats/chi_square.hpp"
#include "stats/t_test.hpp"

namespace deltalux {
using namespace scene;

namespace {

using test::chiSquareDirections;

constexpr double kSignificance = 1e-4;  // per test: a right sampler fails one run of this file in some hundreds

Vec3 directionAt(double degrees) {
  const double t = degrees * kPi / 180;
  return {std::sin(t) * std::cos(0.7), std::sin(t) * std::sin(0.7), std::cos(t)};
}

SpecularLobe lobe(float reflectance, float roughness, SpecularLobe::Distribution distribution) {
  return {Rgb(reflectance), roughness, distribution};
}

Bsdf glossy(float roughness, SpecularLobe::Distribution distribution, float diffuse = 0.0f) {
  Bsdf bsdf;
  bsdf.diffuseReflection = Rgb(diffuse);
  bsdf.reflection = lobe(0.5f, roughness, distribution);
  return bsdf;
}

Bsdf trans() {
  Bsdf bsdf;
  bsdf.diffuseReflection = Rgb(0.2f, 0.1f, 0.0f);
  bsdf.diffuseTransmission = Rgb(0.3f, 0.3f, 0.1f);
  bsdf.reflection = lobe(0.1f, 0.2f, SpecularLobe::Distribution::Ward);
  bsdf.transmission = lobe(0.2f, 0.3f, SpecularLobe::Distribution::Ward);
  return bsdf;
}

void expectSamplesFollowDensity(const Bsdf& bsdf, double degrees) {
  const Vec3 wo = directionAt(degrees);
  const auto draw = [&](const Vec3& u) -> std::optional<Vec3> {
    const auto s = sample(bsdf, wo, u);
    return s && !isDirac(s->event) ? std::optional(s->direction) : std::nullopt;
  };
  const auto density = [&](const Vec3& wi) { return pdf(bsdf, wo, wi); };
  test::DirectionTest around;
  around.axis = {-wo.x, -wo.y, wo.z};
  around.concentration = 4;
  // Densities of sampled directions below the horizon count as "nothing drawn"; pdf() is asked above it alone.
  const auto above = [&](const Vec3& wi) {
    return bsdf.hasFinitePart() && (wi.z > 0 || !isBlack(bsdf.diffuseTransmission)) ? density(wi) : 0.0;
  };
  const auto result = chiSquareDirections(draw, above, around);
  EXPECT_GT(result.pValue, kSignificance) << result.message << ", at " << degrees << " degrees";
}

TEST(BsdfSampling, LambertFollowsItsDensity) {
  Bsdf bsdf;
  bsdf.diffuseReflection = Rgb(0.7f, 0.2f, 0.1f);
  expectSamplesFollowDensity(bsdf, 40);
}

TEST(BsdfSampling, WardFollowsItsDensity) {
  for (float roughness : {0.05f, 0.1f, 0.4f}) {
    for (double degrees : {0.0, 30.0, 70.0})
      expectSamplesFollowDensity(glossy(roughness, SpecularLobe::Distribution::Ward), degrees);
  }
}

TEST(BsdfSampling, GgxFollowsItsDensity) {
  for (float roughness : {0.05f, 0.25f, 0.8f}) {
    for (double degrees : {0.0, 30.0, 70.0})
      expectSamplesFollowDensity(glossy(roughness, SpecularLobe::Distribution::Ggx), degrees);
  }
}

TEST(BsdfSampling, MixturesFollowTheirDensity) {
  expectSamplesFollowDensity(glossy(0.1f, SpecularLobe::Distribution::Ward, 0.4f), 50);
  expectSamplesFollowDensity(trans(), 35);
}

/// Monte Carlo albedo and the integral of evaluate() over the sphere by uniform directions must agree: weights are
/// right.
TEST(BsdfSampling, WeightsIntegrateTheLobe) {
  for (const Bsdf& bsdf :
       {glossy(0.3f, SpecularLobe::Distribution::Ward, 0.3f), glossy(0.4f, SpecularLobe::Distribution::Ggx), trans()}) {
    for (double degrees : {10.0, 60.0}) {
      const Vec3 wo = directionAt(degrees);
      Rng rng(3);
      test::Moments difference;
      for (int i = 0; i < 200000; ++i) {
        const auto s = sample(bsdf, wo, {rng.uniform(), rng.uniform(), rng.uniform()});
        const double z = 1 - 2 * rng.uniform(), r = std::sqrt(1 - z * z), phi = 2 * kPi * rng.uniform();
        const Vec3 wi(r * std::cos(phi), r * std::sin(phi), z);
        difference.add((s ? s->weight.g : 0.0) - evaluate(bsdf, wo, wi).g * 4 * kPi);
      }
      EXPECT_GT(test::tTest(difference, 0.0), kSignificance) << degrees;
    }
  }
}

TEST(Bsdf, LobesAreReciprocal) {
  Rng rng(9);
  for (const auto distribution : {SpecularLobe::Distribution::Ward, SpecularLobe::Distribution::Ggx}) {
    const Bsdf bsdf = glossy(0.2f, distribution, 0.1f);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 a = directionAt(89 * rng.uniform());
      const double t = 1.5 * rng.uniform(), phi = 2 * kPi * rng.uniform();
      const Vec3 b(std::sin(t) * std::cos(phi), std::sin(t) * std::sin(phi), std::cos(t));
      const double ab = evaluate(bsdf, a, b).r / b.z, ba = evaluate(bsdf, b, a).r / a.z;
      EXPECT_NEAR(ab, ba, 1e-5 * std::max(1.0, ab));
    }
  }
}

TEST(Bsdf, LobesReflectNoMoreThanTheyGet) {
  for (const auto distribution : {SpecularLobe::Distribution::Ward, SpecularLobe::Distribution::Ggx}) {
    for (float roughness : {0.02f, 0.1f, 0.3f, 0.6f}) {
      for (double degrees : {0.0, 45.0, 80.0, 88.0}) {
        Rng rng(11);
        test::Moments albedo;
        for (int i = 0; i < 20000; ++i) {
          const auto s = sample(glossy(roughness, distribution), directionAt(degrees),
                                {rng.uniform(), rng.uniform(), rng.uniform()});
          albedo.add(s ? s->weight.r : 0.0);
        }
        EXPECT_LE(albedo.mean(), 0.5 + 4 * albedo.standardError() + 1e-6) << roughness << " " << degrees;
        if (roughness < 0.15f && degrees < 50) {
          EXPECT_NEAR(albedo.mean(), 0.5, 0.01);
        }
      }
    }
  }
}

TEST(Bsdf, MirrorReflectsOnItsFrontAlone) {
  const Material mirror{"m", Mirror{Rgb(0.8f)}, {}};
  const Vec3 wo = directionAt(30);
  const auto s = sample(makeBsdf(mirror, true), wo, {0.5, 0.5, 0.5});
  ASSERT_TRUE(s);
  EXPECT_EQ(s->event, ScatterEvent::MirrorReflection);
  EXPECT_EQ(s->direction, Vec3(-wo.x, -wo.y, wo.z));
  EXPECT_EQ(s->weight, Rgb(0.8f));
  EXPECT_FALSE(sample(makeBsdf(mirror, false), wo, {0.5, 0.5, 0.5}));
}

TEST(Bsdf, PanePassesStraightAndReflects) {
  const ThinGlass glass{Rgb(0.9f, 0.6f, 0.3f), 1.52f};
  const Bsdf bsdf = makeBsdf({"g", glass, {}}, true);
  const Vec3 wo = directionAt(60);
  Rng rng(2);
  test::Moments passed, reflected;
  for (int i = 0; i < 100000; ++i) {
    const auto s = sample(bsdf, wo, {rng.uniform(), 0, 0});
    ASSERT_TRUE(s);
    const bool straight = s->event == ScatterEvent::Passage;
    EXPECT_EQ(s->direction, straight ? -wo : Vec3(-wo.x, -wo.y, wo.z));
    passed.add(straight ? s->weight.g : 0), reflected.add(straight ? 0 : s->weight.g);
  }
  EXPECT_GT(test::tTest(passed, transmittance(glass, wo.z).g), kSignificance);
  EXPECT_GT(test::tTest(reflected, reflectance(glass, wo.z).g), kSignificance);
}

/// Every part by its share: samples of a sheet with gaps carry in the mean what covers it reflects, and what passes.
TEST(Bsdf, CoveredSurfacesPassTheRestStraight) {
  const float share = 0.4f;
  for (const Surface& surface :
       {Surface(Opaque{Rgb(0.5f), {}, {Rgb(0.3f), 0.0f}}), Surface(Trans{Rgb(0.2f), Rgb(0.1f), {}, {Rgb(0.4f), 0.0f}}),
        Surface(ThinGlass{Rgb(0.9f), 1.52f}), Surface(Mirror{Rgb(0.9f)})}) {
    const Material sheet{"s", surface, {}, share, Rgb(1.0f, 0.5f, 0.25f)};
    const Bsdf bsdf = makeBsdf(sheet, true), whole = makeBsdf({"w", surface, {}}, true);
    const Vec3 wo = directionAt(60);
    const Rgb straight = straightTransmittance(sheet, wo.z);
    EXPECT_EQ(passageTransmittance(bsdf, wo.z), straight);
    EXPECT_LT(maxChannel(glm::abs(mirrorReflectance(bsdf, wo.z) - share * mirrorReflectance(whole, wo.z))), 1e-6f);
    for (const double z : {0.5, -0.5}) {
      const Vec3 wi(0, std::sqrt(0.75), z);
      EXPECT_LT(maxChannel(glm::abs(evaluate(bsdf, wo, wi) - share * evaluate(whole, wo, wi))), 1e-6f);
    }
    Rng rng(7);
    test::Moments passed, scattered, ofWhole;
    for (int i = 0; i < 100000; ++i) {
      const auto s = sample(bsdf, wo, {rng.uniform(), rng.uniform(), rng.uniform()});
      ASSERT_TRUE(s);
      const bool passes = s->event == ScatterEvent::Passage;
      if (passes) {
        EXPECT_EQ(s->direction, -wo);
      }
      passed.add(passes ? s->weight.g : 0), scattered.add(passes ? 0 : s->weight.g);
      const auto w = sample(whole, wo, {rng.uniform(), rng.uniform(), rng.uniform()});
      ofWhole.add(w && w->event != ScatterEvent::Passage ? share * w->weight.g : 0);
      const auto first = sample(withoutPassage(bsdf), wo, {rng.uniform(), rng.uniform(), rng.uniform()});
      EXPECT_TRUE(first && first->event != ScatterEvent::Passage);
    }
    EXPECT_GT(test::tTest(passed, straight.g), kSignificance);
    EXPECT_NEAR(scattered.mean(), ofWhole.mean(), 5 * (scattered.standardError() + ofWhole.standardError()) + 1e-6);
  }
}

TEST(Bsdf, BothWaysAreWhatSamplesAreInTheMean) {
  const Vec3 wo = directionAt(50);
  for (const Surface& surface :
       {Surface(ThinGlass{Rgb(0.9f, 0.6f, 0.3f), 1.52f}), Surface(Dielectric{Rgb(1.0f), 1.5f})}) {
    const Bsdf bsdf = makeBsdf({"g", surface, {}}, true);
    const auto both = bothWays(bsdf, wo);
    ASSERT_TRUE(both);
    for (const BsdfSample& way : *both)
      for (const double u : {0.0, 0.999999}) {
        const auto s = sample(bsdf, wo, {u, 0, 0});
        if (s->event != way.event) continue;
        EXPECT_EQ(s->direction, way.direction);
        EXPECT_EQ(s->etaSquared, way.etaSquared);
      }
    EXPECT_EQ((*both)[0].event, ScatterEvent::MirrorReflection);
    EXPECT_NEAR((*both)[0].weight.g, mirrorReflectance(bsdf, wo.z).g, 1e-6);
  }
  const auto grid = bothWays(makeBsdf({"m", Mirror{Rgb(0.9f)}, {}, 0.5f}, true), wo);
  ASSERT_TRUE(grid);
  EXPECT_EQ((*grid)[0].weight, Rgb(0.45f));
  EXPECT_EQ((*grid)[1].weight, Rgb(0.5f));
  const Bsdf glass = makeBsdf({"g", Dielectric{Rgb(1.0f), 1.5f}, {}}, false);
  EXPECT_FALSE(bothWays(glass, directionAt(60)));  // reflected in total
  EXPECT_FALSE(bothWays(makeBsdf({"m", Mirror{Rgb(0.9f)}, {}}, true), wo));
  EXPECT_FALSE(bothWays(makeBsdf({"d", Opaque{Rgb(0.5f), {}, {}}, {}}, true), wo));
}

TEST(Bsdf, DielectricRefractsBySnellAndConservesFlux) {
  const Material glass{"g", Dielectric{Rgb(1.0f), 1.5f}, {}};
  for (bool front : {true, false}) {
    const double ior = front ? 1.5 : 1 / 1.5;
    for (double degrees : {0.0, 20.0, 40.0, 60.0}) {
      const Vec3 wo = directionAt(degrees);
      Rng rng(4);
      double reflectedShare = 0;
      constexpr int n = 20000;
      for (int i = 0; i < n; ++i) {
        const auto s = sample(makeBsdf(glass, front), wo, {rng.uniform(), 0, 0});
        ASSERT_TRUE(s);
        EXPECT_NEAR(s->weight.r, 1.0, 1e-5);  // flux: nothing is lost whichever way it goes
        if (s->event == ScatterEvent::Refraction) {
          EXPECT_NEAR(std::hypot(s->direction.x, s->direction.y) * ior, std::hypot(wo.x, wo.y), 1e-9);
          EXPECT_LT(s->direction.z, 0.0);
          EXPECT_NEAR(s->etaSquared, ior * ior, 1e-9);
        } else {
          ++reflectedShare;
        }
      }
      const double F = fresnelDielectric(wo.z, ior);
      EXPECT_NEAR(reflectedShare / n, F, 4 * std::sqrt(F * (1 - F) / n) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace deltalux
