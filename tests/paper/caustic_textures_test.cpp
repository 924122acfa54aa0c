// The paper's textures by equations (1) to (8); solutions over links show caustics by them, and keep them up to edits.
#include "paper/caustic_textures.hpp"

#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "caustics/synthetic.hpp"
#include "paper/texture_resolution.hpp"
#include "support/run_cli.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

using caustics::SurfaceCaustics;

Engine solvedBox() {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 30000, settings.method = SolveMethod::Paper;
  Engine engine(loadScene({test::bundledScene("cornell-caustic/cornell-caustic.rad")}).scene, settings);
  engine.solve();
  return engine;
}

Edit moveBall(const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{"ball", matrix};
}

/// Irradiance of the texels of one side against another's, relative to the brightest.
double difference(const SurfaceCaustics& a, const SurfaceCaustics& b) {
  if (a.textures.size() != b.textures.size()) return 1;
  double most = 0, brightest = 0;
  for (std::size_t t = 0; t < a.textures.size(); ++t) {
    if (a.textures[t].texels.size() != b.textures[t].texels.size()) return 1;
    for (std::size_t i = 0; i < a.textures[t].texels.size(); ++i) {
      most = std::max<double>(most, gray(glm::abs(a.textures[t].texels[i] - b.textures[t].texels[i])));
      brightest = std::max<double>(brightest, gray(b.textures[t].texels[i]));
    }
  }
  return most / brightest;
}

/// Every side has the textures that equations (1) to (8) make of what lies on it.
void expectPapersTextures(const Engine& engine, double tolerance) {
  const Solution& s = engine.solution().get();
  ASSERT_GT(s.caustics.surfaces.size(), 0u);
  std::map<std::pair<std::size_t, bool>, std::vector<particles::Impact>> bySide;
  for (const particles::Impact& i : particles::impacts(s.particles, s.elements, s.scene))
    bySide[{i.primitive.index(), i.front}].push_back(i);
  for (const auto& [side, impacts] : bySide) {
    const PrimitiveId primitive(side.first);
    const auto made = paper::makeTextures(s.scene[primitive].shape, impacts);
    const SurfaceCaustics* shown = s.caustics.of(primitive, side.second);
    EXPECT_EQ(made.has_value(), shown != nullptr) << side.first;
    if (made && shown) {
      EXPECT_LE(difference(*shown, *made), tolerance) << side.first;
    }
  }
}

/// Flux by texel of a histogram, as E.
caustics::CellLight histogram(const std::vector<float>& gray) {
  caustics::CellLight light;
  light.gray = gray;
  return light;
}

TEST(PaperTextures, ContrastIsThatOfTheExtremes) {
  EXPECT_DOUBLE_EQ(paper::contrast(histogram({0, 3, 1})), 1.0);
  EXPECT_DOUBLE_EQ(paper::contrast(histogram({2, 4, 3})), 0.5);
  EXPECT_EQ(paper::contrast(histogram({0, 0})), 0);
  EXPECT_EQ(paper::contrast(histogram({})), 0);
}

TEST(PaperTextures, LitIsAShareOfTheMaximum) {
  const std::vector<Rgb> E{Rgb(1.0f), Rgb(1.0f), Rgb(2.0f), Rgb(100.0f)};
  EXPECT_EQ(paper::litCells(E, 0.02), (std::vector<char>{0, 0, 1, 1}));
  EXPECT_EQ(paper::litCells({Rgb(0.0f)}, 0.02), std::vector<char>{0});
}

TEST(PaperTextures, TheirResolutionKeepsTheVarianceBelowEpsilon) {
  // (6): 4 K2 2^2d / n <= epsilon, and d + 1 would exceed it.
  for (const double n : {10.0, 100.0, 5000.0, 1e6})
    for (const double epsilon : {0.5, 1.0}) {
      const int d = paper::textureResolution(n, epsilon);
      EXPECT_LE(4 * paper::kBoxKernel * std::exp2(2 * d) / n, epsilon * (1 + 1e-9));
      EXPECT_GT(4 * paper::kBoxKernel * std::exp2(2 * (d + 1)) / n, epsilon);
    }
  EXPECT_EQ(paper::textureResolution(4096, 1), 6);
}

TEST(PaperTextures, TheirTexelsFollowTheSurfacesShape) {
  EXPECT_EQ(paper::textureTexels(4096, 1, {1, 1}), glm::ivec2(64, 64));
  EXPECT_EQ(paper::textureTexels(4096, 1, {4, 1}), glm::ivec2(128, 32));
  EXPECT_EQ(paper::textureTexels(4096, 1, {1, 1e9}), glm::ivec2(1, 4096));
}

/// Two discs that hold 95 % of the flux, and single particles around them.
SurfacePoint twoDiscs(Rng& rng) {
  const double which = rng.uniform();
  if (which < 0.05) return test::evenly(rng);
  const double r = 0.12 * std::sqrt(rng.uniform()), phi = 2 * kPi * rng.uniform();
  return test::inSquare((which < 0.5 ? 0.25 : 0.75) + r * std::cos(phi), 0.5 + r * std::sin(phi));
}

/// Flood fill over what is reconstructed finds the figures; over the histogram it found every single particle.
TEST(PaperTextures, AreRestrictedToTheFigures) {
  const auto s = paper::makeTextures(test::unitSquare(), test::drawImpacts(4000, 1, twoDiscs));
  ASSERT_TRUE(s);
  ASSERT_EQ(s->textures.size(), 3u);
  for (const double x : {0.25, 0.75})
    EXPECT_EQ(std::count_if(s->textures.begin(), s->textures.begin() + 2,
                            [&](const auto& t) {
                              return t.region.contains({x, 0.5});
                            }),
              1);
  for (std::size_t t = 0; t < 2; ++t) {
    const glm::dvec2 size = s->textures[t].region.size();
    EXPECT_LT(size.x * size.y, 0.25);
    EXPECT_GT(s->textures[t].particles, 1500u);
  }
  EXPECT_NEAR(s->flux().r, 1.0, 1e-5);
}

TEST(PaperTextures, TooFewParticlesMakeNoRegion) {
  auto impacts = test::drawImpacts(
      2000, 1, [](Rng& rng) { return test::inSquare(0.2 + 0.1 * rng.uniform(), 0.2 + 0.1 * rng.uniform()); });
  const auto textures = [&] { return paper::makeTextures(test::unitSquare(), impacts)->textures.size(); };
  const std::size_t without = textures();
  for (int i = 0; i < 9; ++i) {  // as bright as the others, far from them
    impacts.push_back(impacts[static_cast<std::size_t>(i)]);
    impacts.back().uv = {0.8f, 0.8f}, impacts.back().flux *= 100.0f;
  }
  EXPECT_EQ(textures(), without);
  impacts.push_back(impacts.back());
  EXPECT_EQ(textures(), without + 1);
}

TEST(PaperTextures, SolutionsOverLinksHaveThem) { expectPapersTextures(solvedBox(), 0.0); }

TEST(PaperTextures, AreMadeAgainWhereParticlesHaveChanged) {
  Engine engine = solvedBox();
  engine.apply(moveBall({0.05, 0, 0.05}));
  const StepReport step = engine.update();
  EXPECT_GT(step.texturesRebuilt, 0u);
  test::expectValid(engine, "motion");
  expectPapersTextures(engine, 0.02);  // others are multiplied as wholes
}

TEST(PaperTextures, FollowALampThatIsDimmed) {
  Engine engine = solvedBox();
  engine.apply(ScaleLight{"lamp", 0.5f});
  engine.update();
  expectPapersTextures(engine, 0.0);
}

}  // namespace
}  // namespace deltalux
