// Caustic textures on every kind of surface: flux, even light, seams, errors that fall with the particles.
#include <gtest/gtest.h>

#include "caustics/adaptive_textures.hpp"
#include "caustics/shapes.hpp"
#include "caustics/synthetic.hpp"
#include "paper/caustic_textures.hpp"

namespace deltalux {
using namespace caustics;

namespace {

/// Points of the shape nearer to `center` than `radius`, uniform by area, and a few anywhere.
std::vector<particles::Impact> patchOn(const Shape& shape, const Vec3& center, double radius, std::size_t count) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return test::drawImpacts(count, 5, [&](Rng& rng) {
    for (;;) {
      const double u = rng.uniform();
      SurfacePoint p = samplePoint(shape, {u, rng.uniform()});
      if (rng.uniform() > 0.02 && glm::distance(p.position, center) > radius) continue;
      if (mesh) {  // impacts on meshes have the triangle's own parameters
        const auto& [a, b, c] = mesh->triangles[p.triangle];
        const Vec3 e1 = mesh->positions[b] - mesh->positions[a], e2 = mesh->positions[c] - mesh->positions[a];
        const Vec3 d = p.position - mesh->positions[a], n = glm::cross(e1, e2);
        p.uv = {glm::dot(glm::cross(d, e2), n) / glm::dot(n, n), glm::dot(glm::cross(e1, d), n) / glm::dot(n, n)};
      }
      return p;
    }
  });
}

/// The integral of what a texture shows, by points uniform over the surface.
double shownFlux(const SurfaceCaustics& s, const Shape& shape) {
  double sum = 0;
  constexpr int n = 200000;
  Rng rng(7);
  for (int i = 0; i < n; ++i) {
    const double u = (i + rng.uniform()) / n;
    sum += s.irradianceAt(samplePoint(shape, {u, rng.uniform()})).r;
  }
  return sum / n * area(shape);
}

class TextureOn : public testing::TestWithParam<test::NamedShape> {};

TEST_P(TextureOn, HoldsAndShowsItsParticlesFlux) {
  const Shape& shape = GetParam().shape;
  const Vec3 center = samplePoint(shape, {0.3, 0.4}).position;
  const auto impacts = patchOn(shape, center, 0.3 * std::sqrt(area(shape) / 4), 6000);
  const auto s = makeCausticTextures(shape, impacts, {0.05, 0});
  ASSERT_TRUE(s);
  EXPECT_NO_THROW(validate(*s));
  EXPECT_NEAR(s->flux().r, 1.0, 1e-5);
  EXPECT_NEAR(shownFlux(*s, shape), 1.0, 0.02);
}

TEST_P(TextureOn, PapersWayHoldsTheFluxToo) {
  const Shape& shape = GetParam().shape;
  const auto impacts = patchOn(shape, samplePoint(shape, {0.3, 0.4}).position, 0.3 * std::sqrt(area(shape) / 4), 6000);
  const auto s = paper::makeTextures(shape, impacts);
  ASSERT_TRUE(s);
  EXPECT_NO_THROW(validate(*s));
  EXPECT_NEAR(s->flux().r, 1.0, 1e-5);
}

TEST_P(TextureOn, EvenLightStaysEvenUpToTheBorders) {
  const Shape& shape = GetParam().shape;
  const auto impacts = patchOn(shape, Vec3(0), 1e9, 20000);
  EXPECT_FALSE(makeCausticTextures(shape, impacts, {0.05, 0}));
  const SurfaceCaustics s = makeUnrestrictedTextures(shape, impacts, {0.05, 0}, 2500);
  EXPECT_NO_THROW(validate(s));
  const double exact = 1 / area(shape);
  Rng rng(9);
  double worst = 0, sum = 0;
  for (int i = 0; i < 2000; ++i) {
    const double u = rng.uniform();
    const double off = std::abs(s.irradianceAt(samplePoint(shape, {u, rng.uniform()})).r / exact - 1);
    worst = std::max(worst, off), sum += off;
  }
  EXPECT_LT(sum / 2000, 0.1);
  EXPECT_LT(worst, std::holds_alternative<Mesh>(shape) ? 1.5 : 0.6);  // a lone texel in the corner of a chart
}

INSTANTIATE_TEST_SUITE_P(Kinds, TextureOn, testing::ValuesIn(test::causticShapes()),
                         [](const auto& kind) { return kind.param.name; });

TEST(CausticTextures, AreSeamlessAroundClosedSurfaces) {
  // The same patch of light on the seam and opposite to it.
  for (const Shape& shape : {Shape(Cylinder{{0, 0, 0}, {0, 0, 1}, 0.4}), Shape(Sphere{{0, 0, 0}, 0.4})}) {
    const auto at = [&](double turn) {
      return test::drawImpacts(8000, 3, [&](Rng& rng) {
        const double u = turn + 0.1 * (rng.uniform() - 0.5) + 1;
        return pointAt(shape, {u - std::floor(u), 0.45 + 0.1 * rng.uniform()});
      });
    };
    const auto inside = makeCausticTextures(shape, at(0.5), {0.05, 0}),
               seam = makeCausticTextures(shape, at(0), {0.05, 0});
    ASSERT_TRUE(inside && seam);
    double largest = 0, difference = 0;
    for (int i = -40; i <= 40; ++i) {
      const double u = 0.5 + 0.002 * i, over = 1.0 + 0.002 * i;
      const double a = inside->irradianceAt(pointAt(shape, {u, 0.5})).r;
      const double b = seam->irradianceAt(pointAt(shape, {over - std::floor(over), 0.5})).r;
      largest = std::max(largest, a), difference = std::max(difference, std::abs(a - b));
    }
    EXPECT_LT(difference, 0.25 * largest);
    EXPECT_EQ(inside->textures.size(), seam->textures.size());
  }
}

TEST(CausticTextures, ErrorFallsInOrderWithTheParticles) {
  std::vector<double> errors;
  for (const std::size_t n : {2000u, 8000u, 32000u}) {
    const auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(n, 1, test::discInEvenLight), {0.05, 0});
    ASSERT_TRUE(s);
    errors.push_back(test::squareError(*s, test::discInEvenLightDensity));
  }
  // A sharp edge allows n^-1/4 at best without knowing where it is (pixels that it crosses dominate); noise alone
  // n^-1/2.
  const double slope = std::log(errors[2] / errors[0]) / std::log(32000.0 / 2000.0);
  EXPECT_LT(slope, -0.17);
  EXPECT_GT(slope, -0.5);
}

TEST(CausticTextures, AreNearerToTheTruthThanThePapers) {
  const auto impacts = test::drawImpacts(4000, 1, test::discInEvenLight);
  const auto ours = makeCausticTextures(test::unitSquare(), impacts, {0.05, 0});
  const auto papers = paper::makeTextures(test::unitSquare(), impacts);
  ASSERT_TRUE(ours && papers);
  EXPECT_LT(test::squareError(*ours, test::discInEvenLightDensity),
            0.6 * test::squareError(*papers, test::discInEvenLightDensity));
}

TEST(CausticTextures, AreRestrictedToTheFigure) {
  const auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(4000, 1, test::discInEvenLight), {0.05, 0});
  ASSERT_TRUE(s);
  ASSERT_EQ(s->textures.size(), 2u);
  const Region& r = s->textures[0].region;
  EXPECT_TRUE(r.contains({0.48, 0.4}) && r.contains({0.72, 0.4}) && r.contains({0.6, 0.28}) && r.contains({0.6, 0.52}));
  EXPECT_LT(r.size().x * r.size().y, 0.2);
}

TEST(CausticTextures, AreTheSameInAllUnits) {
  const auto impacts = test::drawImpacts(4000, 1, test::discInEvenLight);
  const auto unit = makeCausticTextures(test::unitSquare(), impacts, {0.05, 0});
  ASSERT_TRUE(unit);
  for (const double size : {1e-6, 1e5}) {
    const Shape square = *makePolygon({{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}});
    const auto scaled = makeCausticTextures(square, impacts, {0.05, 0});
    ASSERT_TRUE(scaled);
    EXPECT_NO_THROW(validate(*scaled));
    ASSERT_EQ(scaled->textures.size(), unit->textures.size());
    double difference = 0, light = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double u = (x + 0.5) / 64, v = (y + 0.5) / 64;
        SurfacePoint p = test::inSquare(u, v);
        const double E = unit->irradianceAt(p).r;
        p.position *= size;
        difference += std::abs(size * size * scaled->irradianceAt(p).r - E), light += E;
      }
    EXPECT_LT(difference, 0.02 * light) << size;
  }
}

TEST(CausticTextures, FewParticlesAreLeftToTheMesh) {
  EXPECT_FALSE(makeCausticTextures(test::unitSquare(), test::drawImpacts(3, 1, test::discInEvenLight), {0.05, 0}));
  EXPECT_FALSE(makeCausticTextures(test::unitSquare(), {}, {0.05, 0}));
  EXPECT_FALSE(paper::makeTextures(test::unitSquare(), test::drawImpacts(9, 1, test::discInEvenLight)));
}

TEST(CausticTextures, ValidateFindsLostFlux) {
  auto s = makeCausticTextures(test::unitSquare(), test::drawImpacts(4000, 1, test::discInEvenLight), {0.05, 0});
  for (Rgb& texel : s->textures[0].texels) texel *= 1.01f;
  EXPECT_THROW(validate(*s), std::logic_error);
}

}  // namespace
}  // namespace deltalux
