// Motion: whatever frames put off, light is nowhere twice, and in the end everything is as if there had been no frames.
#include <gtest/gtest.h>

#include <deltalux/check.hpp>
#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/motion.hpp"
#include "particles/transfer.hpp"
#include "scene/nominal_scale.hpp"
#include "support/solved.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
using namespace engine;

namespace {

constexpr double kNoTime = 1e-3, kAllTime = 1e6;  // [ms]

Engine cornell() {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 20000;
  Engine engine(loadScene({DELTALUX_SOURCE_DIR "/scenes/cornell-caustic/cornell-caustic.rad"}).scene, settings);
  engine.solve();
  return engine;
}

Edit shift(const std::string& object, const Vec3& by) { return TransformObject{object, glm::translate(Mat4(1.0), by)}; }

std::vector<Edit> drag() {
  return {shift("ball", {0.03, 0, 0.02}), shift("ball", {0.03, 0, 0.02}), shift("short_block", {0.02, 0, 0.01}),
          shift("ball", {-0.02, 0, 0.02})};
}

std::vector<Rgb> radiosities(const hierarchy::Elements& elements) {
  std::vector<Rgb> B;
  for (const hierarchy::ElementLight& l : elements.radiometry) B.push_back(l.B);
  return B;
}

/// The light of particles at every leaf is that of the paths as they are, each once, of senders that have B.
void expectEachPathOnce(const Solution& s, const std::vector<Rgb>& B, double tolerance) {
  hierarchy::Elements elements = s.elements;
  ASSERT_EQ(B.size(), elements.size());
  for (std::size_t i = 0; i < B.size(); ++i) elements.radiometry[i].B = B[i];
  particles::ParticleTransfer(s.particles, elements, s.scene).apply(elements, scene::scalesOf(s.scene));
  double sum = 0, difference = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements.topology[i].childCount > 0) continue;
    const double area = elements.geometry[i].area;
    sum += area * gray(elements.radiometry[i].particle);
    difference += area * gray(glm::abs(elements.radiometry[i].particle - s.elements.radiometry[i].particle));
  }
  EXPECT_GT(sum, 0);
  EXPECT_LT(difference, tolerance * sum);
}

/// Of senders as they are in the end: frames end before the light is settled.
void expectEachPathOnce(const Solution& s) { expectEachPathOnce(s, radiosities(s.elements), 0.01); }

/// Textures hold the flux of the particles on their side.
void expectTexturesHoldTheFlux(const Solution& s) {
  std::vector<RgbSum> flux(s.caustics.surfaces.size(), RgbSum(0.0));
  for (const particles::Impact& i : particles::impacts(s.particles, s.elements, s.scene))
    if (const caustics::SurfaceCaustics* side = s.caustics.of(i.primitive, i.front))
      flux[static_cast<std::size_t>(side - s.caustics.surfaces.data())] += RgbSum(i.flux);
  for (std::size_t i = 0; i < flux.size(); ++i)
    EXPECT_NEAR(gray(s.caustics.surfaces[i].flux()) / gray(flux[i]), 1.0, 0.01) << "side " << i;
}

TEST(Motion, SettlesToWhatOneUpdateGives) {
  Engine dragged = cornell(), at_once = cornell();
  for (const Edit& e : drag()) {
    dragged.apply(e);
    dragged.frame(kNoTime);
    at_once.apply(e);
  }
  const StepReport settled = dragged.update();
  at_once.update();
  EXPECT_EQ(settled.deferred, 0u);
  EXPECT_FALSE(settled.staleW);
  const Solution &a = dragged.solution().get(), &b = at_once.solution().get();
  EXPECT_NO_THROW(validate(a.particles, a.scene));
  EXPECT_NO_THROW(a.transfers.validate(a.elements, a.links));
  EXPECT_NO_THROW(validate(a.caustics));
  EXPECT_EQ(a.particles.hash(), b.particles.hash());
  EXPECT_EQ(a.particles.hash(),
            particles::traceParticles(a.scene, *tracing::makeEmbreeTracer(a.scene), {20000, a.settings.seed}).hash());
  // Rows are dealt out by the light there is, which the frames had already moved.
  const CheckReport check = compareSolutions(dragged.solution(), at_once.solution(), test::kQuickCheck);
  EXPECT_LT(check.medianRelDiff, 0.005);
  EXPECT_LT(check.p95RelDiff, 0.03);
  EXPECT_EQ(a.caustics.count(), b.caustics.count());
}

TEST(Motion, NoLightIsThereTwice) {
  Engine engine = cornell();
  ASSERT_GT(engine.solution().get().caustics.count(), 0u);
  EXPECT_EQ(engine.solution().report().memory.octree, 0u);
  engine.select("ball");
  EXPECT_GE(8 * engine.solution().report().memory.octree, engine.solution().get().particles.paths());
  bool waited = false;
  for (const Edit& e : drag()) {
    // A frame without time hands the light of particles on once, of senders as the frame before has left them.
    const std::vector<Rgb> before = radiosities(engine.solution().get().elements);
    engine.apply(e);
    const StepReport step = engine.frame(kNoTime);
    waited |= step.deferred > 1;
    ASSERT_TRUE(step.staleW);
    EXPECT_GT(*step.staleW, 0);
    expectEachPathOnce(engine.solution().get(), before, 1e-5);
    expectTexturesHoldTheFlux(engine.solution().get());
  }
  EXPECT_TRUE(waited);
}

/// Frames without edits go on with what waits, and those with all the time in the world leave nothing.
TEST(Motion, FramesDrainWhatWaits) {
  Engine engine = cornell();
  engine.apply(shift("ball", {0.05, 0, 0.05}));
  const StepReport first = engine.frame(kNoTime), second = engine.frame(kNoTime);
  EXPECT_GT(first.particlesRetraced, 0u);
  EXPECT_LT(second.deferred, first.deferred);
  EXPECT_LT(*second.staleW, *first.staleW);
  const StepReport last = engine.frame(kAllTime);
  EXPECT_EQ(last.deferred, 0u);
  EXPECT_EQ(*last.staleW, 0.0);
  expectEachPathOnce(engine.solution().get());
}

void expectSame(const Engine& a, const Engine& b) {
  EXPECT_NO_THROW(a.solution().get().transfers.validate(a.solution().get().elements, a.solution().get().links));
  EXPECT_EQ(a.solution().get().particles.hash(), b.solution().get().particles.hash());
  // Rows are dealt out by the light there is, which the frames had already moved.
  const CheckReport check = compareSolutions(a.solution(), b.solution(), test::kQuickCheck);
  EXPECT_LT(check.medianRelDiff, 0.005);
  EXPECT_LT(check.p95RelDiff, 0.03);
}

/// In a drag that goes on and on, links follow now and then, and rows in between, slice by slice.
TEST(Motion, LinksFollowNowAndThenAndRowsInSlices) {
  Engine dragged = cornell(), at_once = cornell();
  dragged.select("ball");
  int withLinks = 0, withRows = 0;
  for (int i = 0; i < 3 * kFramesBetween; ++i) {
    const Edit e = shift("ball", {0.001, 0, 0.001});
    dragged.apply(e), at_once.apply(e);
    const StepReport step = dragged.frame(kNoTime);
    const bool links = step.linksVisited > 0;
    withLinks += links, withRows += !links && step.leavesExamined == 0 && step.deferred > 1;
    ASSERT_TRUE(step.staleW);
    const Solution& now = dragged.solution().get();
    ASSERT_NO_THROW(now.transfers.validate(now.elements, now.links));
    if (links) expectEachPathOnce(now);
  }
  EXPECT_GE(withLinks, 1);
  EXPECT_LE(withLinks, 3);
  EXPECT_GT(withRows, kFramesBetween);
  EXPECT_EQ(dragged.update().deferred, 0u);
  at_once.update();
  expectSame(dragged, at_once);
}

/// When motion stops, frames alone come to what an update gives, and what is stale goes down all the way.
TEST(Motion, FramesAloneGetThere) {
  Engine dragged = cornell(), at_once = cornell();
  const Edit e = shift("short_block", {0.03, 0, 0.01});
  dragged.apply(e), at_once.apply(e);
  StepReport step = dragged.frame(kNoTime);
  std::size_t slices = 0;
  double stale = *step.staleW;
  for (int i = 0; i < 2000 && step.deferred > 0; ++i) {
    step = dragged.frame(kNoTime);
    slices += step.linksVisited == 0 && step.leavesChanged > 0;
    EXPECT_LE(*step.staleW, 1.01 * stale);
    stale = *step.staleW;
  }
  EXPECT_EQ(step.deferred, 0u);
  EXPECT_EQ(stale, 0.0);
  EXPECT_GT(slices, 5u);
  at_once.update();
  dragged.frame(kAllTime);  // settles
  EXPECT_EQ(dragged.solution().get().particles.hash(), at_once.solution().get().particles.hash());
  // Only updates split the mesh where particles have landed.
  EXPECT_LT(compareSolutions(dragged.solution(), at_once.solution(), test::kQuickCheck).p95RelDiff, 0.1);
  dragged.update();
  expectSame(dragged, at_once);
}

/// What deposits the most goes first.
TEST(Motion, TheBrightestGoFirst) {
  Engine engine = cornell();
  engine.apply(shift("ball", {0.05, 0, 0.05}));
  const StepReport first = engine.frame(kNoTime);
  ASSERT_GT(first.deferred, 500u);
  const StepReport second = engine.frame(kNoTime);
  const StepReport third = engine.frame(kNoTime);
  EXPECT_GE(*first.staleW - *second.staleW, *second.staleW - *third.staleW);
}

TEST(Motion, WithoutParticlesToo) {
  SolveSettings settings;
  settings.error = 0.1, settings.diffuseOnly = true;
  Engine engine(loadScene({DELTALUX_SOURCE_DIR "/scenes/cornell/cornell.rad"}).scene, settings);
  engine.solve();
  engine.select("short_block");
  engine.apply(shift("short_block", {0.02, 0, 0.01}));
  const StepReport frame = engine.frame(kNoTime);
  EXPECT_GT(frame.deferred, 0u);
  EXPECT_GT(*frame.staleW, 0);
  const StepReport last = engine.frame(kAllTime);
  EXPECT_EQ(last.deferred, 0u);
  EXPECT_GT(last.linksVisited, 0u);
  engine.update();
  EXPECT_NO_THROW(
      engine.solution().get().transfers.validate(engine.solution().get().elements, engine.solution().get().links));
}

TEST(Motion, OtherEditsWaitForTheEnd) {
  Engine engine = cornell(), fresh = cornell();
  for (Engine* e : {&engine, &fresh}) {
    e->apply(SetMaterial{"tall_block_surface", Rgb(0.5f), std::nullopt});
    e->apply(ScaleLight{"lamp", 0.5f});
  }
  EXPECT_EQ(engine.frame(kNoTime).particlesRetraced, 0u);
  engine.update();
  fresh.update();
  EXPECT_EQ(engine.solution().get().particles.hash(), fresh.solution().get().particles.hash());
  EXPECT_LT(compareSolutions(engine.solution(), fresh.solution(), test::kQuickCheck).p95RelDiff, 1e-3);
}

}  // namespace
}  // namespace deltalux
