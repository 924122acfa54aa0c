// After an edit the particles that are left and those traced anew are the very set that a scene with that edit has.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "paper/coarse_solution.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/segment_box.hpp"
#include "particles/transfer.hpp"
#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr std::uint64_t kCount = 30000;

Scene cornell() {
  Scene scene = loadScene({DELTALUX_SOURCE_DIR "/scenes/cornell-caustic/cornell-caustic.rad"}).scene;
  addAreaLights(scene);
  return scene;
}

/// The sun shines in by the open side.
Scene sunlitCornell() {
  Scene scene = cornell();
  test::addLight(scene, SunLight{glm::normalize(Vec3(0.1, 0.3, -1)), 0.005, Rgb(2e4f)});
  scene.lights.back().name = "sun";
  return scene;
}

/// The lamp shines in a cone.
Scene spotlitCornell() {
  Scene scene = cornell();
  for (const Light& light : scene.lights)
    if (const auto* lamp = std::get_if<AreaLight>(&light.emitter))
      scene.materials[scene[lamp->primitive].material.index()].emission->spot = SpotCone{2.0, Vec3(0, -0.1, 0)};
  return scene;
}

struct World {
  Scene scene = cornell();
  std::unique_ptr<tracing::RayTracer> tracer = tracing::makeEmbreeTracer(scene);
  ParticleSettings settings = {kCount, 1, 64};
  ParticleTracing tracing{scene, *tracer, settings};
  Particles particles = tracing.trace();

  ParticleUpdate apply(const Edit& edit) { return follow(applyEdit(scene, edit)); }
  ParticleUpdate follow(const AppliedEdit& applied) {
    tracer->rebuild(tracing::GroupId(0));
    return tracing.follow(particles, applied.change);
  }
  Particles fresh() const { return traceParticles(scene, *tracing::makeEmbreeTracer(scene), settings); }
};

Mat4 translation(const Vec3& v) { return glm::translate(Mat4(1.0), v); }
Mat4 turn(double angle, const Vec3& about) {
  return translation(about) * glm::rotate(Mat4(1.0), angle, Vec3(0, 1, 0)) * translation(-about);
}

void expectFresh(World& w) {
  EXPECT_NO_THROW(validate(w.particles, w.scene));
  const std::uint64_t hash = w.fresh().hash();
  EXPECT_EQ(w.particles.hash(), hash);
  w.particles.compact();
  EXPECT_NO_THROW(validate(w.particles, w.scene));
  EXPECT_EQ(w.particles.hash(), hash);
}

/// What is traced anew after an edit, as a share of all.
double expectFollowed(World& w, const Edit& edit) {
  const std::uint64_t before = w.particles.hash();
  const ParticleUpdate u = w.apply(edit);
  EXPECT_FALSE(u.all);
  EXPECT_NE(w.particles.hash(), before);
  expectFresh(w);
  return double(u.paths.size()) / double(w.particles.paths());
}

// In so small a room everything stands in the way of much; but never of all.
TEST(ParticleEdits, DiffuseBoxMoves) {
  World w;
  EXPECT_LT(expectFollowed(w, TransformObject{"short_block", translation({0.02, 0, 0.03})}), 0.3);
}
TEST(ParticleEdits, MirrorMoves) {
  World w;
  EXPECT_LT(expectFollowed(w, TransformObject{"tall_block", turn(0.1, {0.37, 0, 0.35})}), 0.8);
}
TEST(ParticleEdits, GlassBallMoves) {
  World w;
  EXPECT_LT(expectFollowed(w, TransformObject{"ball", translation({0.1, 0, 0.1})}), 0.35);
}
TEST(ParticleEdits, LampMovesWithItsLight) {
  World w;
  expectFollowed(w, TransformObject{"lamp", translation({0.05, 0, 0})});
}
TEST(ParticleEdits, ThingsGrow) {
  World w;
  expectFollowed(w, TransformObject{"ball", glm::scale(Mat4(1.0), Vec3(0.9))});
}

TEST(ParticleEdits, ThereAndBackIsNothing) {
  World w;
  const std::uint64_t hash = w.particles.hash();
  const std::vector<Edit> edits = {TransformObject{"ball", translation({0.1, 0.05, 0})},
                                   TransformObject{"tall_block", turn(0.3, {0.37, 0, 0.35})}, RemoveObject{"ball"}};
  EditHistory history;
  for (const Edit& e : edits) {
    w.follow(history.apply(w.scene, e));
    expectFresh(w);
  }
  while (history.canUndo()) w.follow(history.undo(w.scene));
  EXPECT_EQ(w.particles.hash(), hash);
}

/// Also where clusters hold what moves and what does not, and where what moves is a lamp.
TEST(ParticleEdits, EveryThingOfAHouseThereAndBackIsNothing) {
  Scene house = loadScene({DELTALUX_SOURCE_DIR "/scenes/lodge/morning.rad"}).scene;
  addAreaLights(house);
  World w{std::move(house)};
  const std::uint64_t hash = w.particles.hash();
  std::vector<std::string> things;
  for (const Object& o : w.scene.objects)
    if (!o.parent.valid()) things.push_back(o.name);
  ASSERT_GT(things.size(), 50u);
  EditHistory history;
  for (const std::string& thing : things) {
    w.follow(history.apply(w.scene, TransformObject{thing, translation({0.03, -0.02, 0.01}) *
                                                               glm::rotate(Mat4(1.0), 0.05, Vec3(0, 0, 1))}));
    w.follow(history.undo(w.scene));
    ASSERT_EQ(w.particles.hash(), hash) << thing;
  }
}

/// A lamp that was turned has a material of its own; undone, it has that which was there all the time.
TEST(ParticleEdits, ASpotTurnsAndBackIsNothing) {
  World w{spotlitCornell()};
  const std::uint64_t hash = w.particles.hash();
  EditHistory history;
  EXPECT_TRUE(w.follow(history.apply(w.scene, AimLight{"lamp", Vec3(0.3, -1, 0)})).all);
  expectFresh(w);
  EXPECT_NE(w.particles.hash(), hash);
  EXPECT_TRUE(w.follow(history.undo(w.scene)).all);
  EXPECT_EQ(w.particles.hash(), hash);
}

TEST(ParticleEdits, DimmedLampsAndNewWallsTouchNothing) {
  World w;
  const std::uint64_t hash = w.particles.hash();
  for (const Edit& e : {Edit(ScaleLight{"lamp", 0.2f}), Edit(ColourLight{"lamp", Rgb(1.0f, 0.5f, 0.2f)}),
                        Edit(SwitchLight{"lamp", false}), Edit(SetMaterial{"white", Rgb(0.3f), std::nullopt})}) {
    const ParticleUpdate u = w.apply(e);
    EXPECT_FALSE(u.all);
    EXPECT_EQ(u.paths.size(), 0u);
    EXPECT_EQ(u.rays, 0u);
    EXPECT_EQ(w.particles.hash(), hash);
  }
  expectFresh(w);
}

TEST(ParticleEdits, OtherMirrorsTraceAllAnew) {
  World w;
  EXPECT_TRUE(w.apply(SetMaterial{"tall_block_surface", Rgb(0.5f), std::nullopt}).all);
  expectFresh(w);
}

std::size_t arrivedFromTheSun(const World& w) {
  const Particles& p = w.particles;
  std::size_t count = 0;
  for (std::size_t path = 0; path < p.paths(); ++path)
    count += p.senderCells[p.sender[path]].kind == SenderKind::Sun && (p.termination[path] & kArrived);
  return count;
}

/// What the emitters of a light at infinity are drawn from turns with it, and is right for what moves later.
TEST(ParticleEdits, TheSunTurns) {
  World w{sunlitCornell()};
  for (const Vec3& shines : {Vec3(0.3, -0.2, 1), Vec3(-0.2, -0.4, 1)}) {
    EXPECT_TRUE(w.apply(AimLight{"sun", shines}).all);
    EXPECT_GT(arrivedFromTheSun(w), 500u);
    expectFresh(w);
    EXPECT_EQ(w.apply(ColourLight{"sun", Rgb(1.0f, 0.5f, 0.2f)}).rays, 0u);
    expectFresh(w);
    expectFollowed(w, TransformObject{"tall_block", turn(0.1, {0.37, 0, 0.35})});
  }
}

/// A tracer that has the moving thing in a group of its own finds the same.
TEST(ParticleEdits, InGroupsOfTheTracer) {
  World w;
  const std::vector<PrimitiveId> ball = primitivesOf(w.scene, findObjects(w.scene, "ball").front());
  const tracing::GroupId group = w.tracer->separate(ball);
  for (const double x : {0.05, 0.05, -0.2}) {
    const AppliedEdit applied = applyEdit(w.scene, TransformObject{"ball", translation({x, 0, 0.02})});
    w.tracer->rebuild(group);
    w.tracing.follow(w.particles, applied.change);
    expectFresh(w);
  }
}

/// What a solution file holds is enough to go on from.
TEST(ParticleEdits, FromParticlesAlone) {
  World w;
  ParticleTracing other(w.scene, *w.tracer, w.settings);
  const AppliedEdit applied = applyEdit(w.scene, TransformObject{"ball", translation({0.1, 0, 0.1})});
  w.tracer->rebuild(tracing::GroupId(0));
  other.follow(w.particles, applied.change);
  expectFresh(w);
}

std::vector<Rgb> irradiances(const ParticleTransfer& transfer, hierarchy::Elements& elements, const Scene& scene) {
  transfer.apply(elements, scene::scalesOf(scene));
  std::vector<Rgb> E;
  for (const hierarchy::ElementLight& l : elements.radiometry) E.push_back(l.particle);
  return E;
}

/// Splits some of the leaves that particles land on.
void splitLeaves(hierarchy::Elements& elements, const Scene& scene, std::size_t every) {
  const std::size_t count = elements.size();
  for (std::size_t i = 0; i < count; i += every)
    if (elements.receives(hierarchy::ElementId(i)) && !isBlack(elements.radiometry[i].particle))
      hierarchy::subdivide(elements, scene, hierarchy::ElementId(i));
}

/// Transfers that follow are those made anew.
TEST(ParticleEdits, TransferFollows) {
  World w;
  hierarchy::Elements elements = hierarchy::buildElements(w.scene, hierarchy::surfaceSides(w.scene));
  Details details;
  subdivideForParticles(elements, w.scene, w.particles, std::vector<bool>(2 * w.scene.primitives.size()), details);
  for (std::size_t i = 0; i < elements.size(); ++i) elements.radiometry[i].B = Rgb(0.1f + 0.01f * float(i % 7));
  ParticleTransfer transfer(w.particles, elements, w.scene);
  std::vector<Rgb> before = irradiances(transfer, elements, w.scene);
  std::size_t every = 5;
  for (const Edit& e : {Edit(TransformObject{"ball", translation({0.1, 0, 0.1})}),
                        Edit(TransformObject{"tall_block", turn(0.1, {0.37, 0, 0.35})}), Edit(RemoveObject{"ball"})}) {
    const ParticleUpdate u = w.apply(e);
    splitLeaves(elements, w.scene, every++);
    transfer.follow(w.particles, u, elements, w.scene);
    const std::vector<Rgb> E = irradiances(transfer, elements, w.scene);
    const std::vector<Rgb> fresh = irradiances(ParticleTransfer(w.particles, elements, w.scene), elements, w.scene);
    EXPECT_NE(E, before);
    for (std::size_t i = 0; i < E.size(); ++i) EXPECT_NEAR(gray(E[i]), gray(fresh[i]), 1e-5 * (1 + gray(fresh[i])));
    before = E;
  }
}

TEST(SegmentBox, MeetsWhatPassesThrough) {
  Rng rng(3, 1);
  const auto number = [&] { return static_cast<float>(4 * rng.uniform() - 2); };
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Box box{Vec3(-0.5, -0.3, -0.1), Vec3(0.5, 0.4, 0.2)};
    const Vec3f a(number(), number(), number()), b(number(), number(), number());
    bool inside = false;
    for (int k = 0; k <= 200 && !inside; ++k) inside = box.contains(Vec3(a) + k / 200.0 * Vec3(b - a));
    const bool meets = SegmentBox(box, 0.0).meets(a, b);
    if (inside) {
      EXPECT_TRUE(meets);
    } else {
      EXPECT_FALSE(SegmentBox(box, -0.02).meets(a, b));
    }
    met += meets;
  }
  EXPECT_GT(met, 50);
}

}  // namespace
}  // namespace deltalux
