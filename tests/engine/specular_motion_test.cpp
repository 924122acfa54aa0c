// Mirrors, glass, brass and lamps that move themselves: updates give what a fresh solve of the moved scene does.
#include <gtest/gtest.h>

#include <deltalux/check.hpp>
#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "support/solved.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

constexpr std::uint64_t kCount = 50000;

Engine solvedScene(const std::string& file, std::uint64_t particles = kCount) {
  SolveSettings settings;
  settings.particles = particles;
  Engine engine(loadScene({DELTALUX_SOURCE_DIR "/scenes/" + file}).scene, settings);
  engine.solve();
  return engine;
}

Mat4 translation(const Vec3& v) { return glm::translate(Mat4(1.0), v); }
Mat4 turn(double degrees, const Vec3& axis, const Vec3& about) {
  return translation(about) * glm::rotate(Mat4(1.0), glm::radians(degrees), axis) * translation(-about);
}

double depositedFlux(const Solution& s) {
  double sum = 0;
  for (const particles::Impact& i : particles::impacts(s.particles, s.elements, s.scene)) sum += gray(i.flux);
  return sum;
}

void expectFresh(Engine& engine, const Edit& edit, double p95) {
  engine.apply(edit);
  const StepReport step = engine.update();
  EXPECT_GT(step.particlesRetraced, 0u);
  const Solution& s = engine.solution().get();
  EXPECT_NO_THROW(validate(s.particles, s.scene));
  Engine fresh(s.scene, s.settings);
  fresh.solve();
  const Solution& t = fresh.solution().get();
  EXPECT_EQ(s.particles.hash(), t.particles.hash());
  EXPECT_NEAR(depositedFlux(s) / depositedFlux(t), 1.0, 0.01);
  const CheckReport check = compareSolutions(engine.solution(), fresh.solution(), test::kQuickCheck);
  EXPECT_TRUE(check.particlesIdentical);
  EXPECT_LT(check.medianRelDiff, 0.005);
  EXPECT_LT(check.p95RelDiff, p95);
}

TEST(SpecularMotion, MirrorTurns) {
  Engine engine = solvedScene("cornell-caustic/cornell-caustic.rad");
  expectFresh(engine, TransformObject{"tall_block", turn(5, {0, 1, 0}, {0.37, 0, 0.35})}, 0.02);
}
TEST(SpecularMotion, GlassMoves) {
  Engine engine = solvedScene("cornell-caustic/cornell-caustic.rad");
  expectFresh(engine, TransformObject{"ball", translation({0.04, 0.01, 0.03})}, 0.02);
}
TEST(SpecularMotion, LampMoves) {
  Engine engine = solvedScene("cornell-caustic/cornell-caustic.rad");
  expectFresh(engine, TransformObject{"lamp", translation({0.04, 0, 0.02})}, 0.03);
}
TEST(SpecularMotion, SpotMoves) {
  Engine engine = solvedScene("ring/ring.rad");
  expectFresh(engine, TransformObject{"lamp", translation({0, 0.01, 0})}, 0.12);
}
// Between its shells, which no light but particles reaches, before and after.
TEST(SpecularMotion, RingMoves) {
  Engine engine = solvedScene("ring/ring.rad", 2 * kCount);
  expectFresh(engine, TransformObject{"ring", translation({0.01, 0.01, 0})}, 0.02);
}

}  // namespace
}  // namespace deltalux
