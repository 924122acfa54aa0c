// Links that a motion affects are emitted again as wholes: the particles are those of the moved scene.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "paper/incremental_particles.hpp"

namespace deltalux {
using paper::IncrementalParticles;

namespace {

Scene cornell() {
  Scene scene = loadScene({DELTALUX_SOURCE_DIR "/scenes/cornell-caustic/cornell-caustic.rad"}).scene;
  addAreaLights(scene);
  return scene;
}

struct World {
  Scene scene = cornell();
  std::unique_ptr<tracing::RayTracer> tracer = tracing::makeEmbreeTracer(scene);
  particles::ParticleSettings settings = {8000, 1, 64};
  particles::ParticleTracing tracing{scene, *tracer, settings};
  particles::Particles particles = tracing.trace();
  IncrementalParticles incremental{scene, tracing};

  particles::ParticleUpdate apply(const Edit& edit, double share = 1) { return follow(applyEdit(scene, edit), share); }
  particles::ParticleUpdate follow(const AppliedEdit& applied, double share = 1) {
    tracer->rebuild(tracing::GroupId(0));
    return incremental.follow(particles, applied.change, share);
  }
  std::uint64_t freshHash() const {
    return particles::traceParticles(scene, *tracing::makeEmbreeTracer(scene), settings).hash();
  }
  std::size_t links(const particles::ParticleUpdate& u) const {
    std::vector<std::uint32_t> links;
    for (const auto& r : u.paths) links.push_back(particles.link[r.path]);
    std::sort(links.begin(), links.end());
    return static_cast<std::size_t>(std::unique(links.begin(), links.end()) - links.begin());
  }
};

Mat4 translation(const Vec3& v) { return glm::translate(Mat4(1.0), v); }

void expectFresh(World& w) {
  EXPECT_NO_THROW(validate(w.particles, w.scene));
  if (w.incremental.octree()) {
    EXPECT_NO_THROW(w.incremental.octree()->validate(w.particles));
  }
  EXPECT_EQ(w.particles.hash(), w.freshHash());
}

const std::vector<Edit> kMotions = {TransformObject{"short_block", translation({0.02, 0, 0.03})},
                                    TransformObject{"ball", translation({0.1, 0, 0.1})},
                                    TransformObject{"tall_block", translation({0.02, 0, 0})},
                                    TransformObject{"ball", glm::scale(Mat4(1.0), Vec3(0.9))},
                                    TransformObject{"lamp", translation({0.05, 0, 0})},
                                    RemoveObject{"ball"}};

TEST(IncrementalParticles, LeaveTheParticlesOfTheMovedScene) {
  World w;
  for (const Edit& e : kMotions) {
    const std::uint64_t before = w.particles.hash();
    const particles::ParticleUpdate u = w.apply(e);
    EXPECT_FALSE(u.all);
    EXPECT_NE(w.particles.hash(), before);
    expectFresh(w);
  }
  w.particles.compact();
  EXPECT_EQ(w.particles.hash(), w.freshHash());
}

TEST(IncrementalParticles, ThereAndBackIsNothing) {
  World w;
  const std::uint64_t hash = w.particles.hash();
  EditHistory history;
  for (const Edit& e : kMotions) w.follow(history.apply(w.scene, e));
  while (history.canUndo()) w.follow(history.undo(w.scene));
  EXPECT_EQ(w.particles.hash(), hash);
}

TEST(IncrementalParticles, EmitWholeLinksAndKeepWhatDidNotChange) {
  World w;
  const particles::ParticleUpdate u = w.apply(TransformObject{"ball", translation({0.1, 0, 0.1})});
  EXPECT_GT(u.paths.size(), 0u);
  EXPECT_GT(u.rays, u.paths.size());
  // Of links that are re-emitted, many paths come out as they were.
  EXPECT_LT(u.paths.size(), u.rays / 2);
  EXPECT_LT(w.links(u), w.particles.links.size());
}

TEST(IncrementalParticles, AShareIsEmittedAndTheRestCaughtUp) {
  World w;
  w.incremental.select(w.particles, primitivesOf(w.scene, findObjects(w.scene, "ball").front()));
  EXPECT_GT(w.incremental.octreeBytes(), 0u);
  std::size_t waiting = 0;
  for (int frame = 0; frame < 4; ++frame) {
    w.apply(TransformObject{"ball", translation({0.03, 0, 0.02})}, 0.1);
    EXPECT_GT(w.incremental.waiting(), waiting / 2);
    waiting = w.incremental.waiting();
    EXPECT_NO_THROW(validate(w.particles, w.scene));
    EXPECT_NE(w.particles.hash(), w.freshHash());
  }
  ASSERT_GT(waiting, 0u);
  w.incremental.follow(w.particles, {}, 1);
  EXPECT_EQ(w.incremental.waiting(), 0u);
  expectFresh(w);
}

TEST(IncrementalParticles, OtherMirrorsTraceAllAnew) {
  World w;
  w.apply(TransformObject{"ball", translation({0.1, 0, 0})}, 0.1);
  EXPECT_TRUE(w.apply(SetMaterial{"tall_block_surface", Rgb(0.5f), std::nullopt}).all);
  EXPECT_EQ(w.incremental.waiting(), 0u);
  expectFresh(w);
  w.apply(TransformObject{"ball", translation({-0.1, 0, 0})});
  expectFresh(w);
}

}  // namespace
}  // namespace deltalux
