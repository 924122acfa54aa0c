// Walks that look for light: what they find, that those which are known are taken, and that what is kept of them holds
// every ray.
#include "lines/enclosed_sides.hpp"

#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <mutex>

#include "change/known_samples.hpp"
#include "hierarchy/build.hpp"
#include "support/rooms.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using namespace test;
using lines::LightWalks;

/// Tells every ray that was asked, by one thread at a time.
class ToldTracer : public tracing::RayTracer {
 public:
  explicit ToldTracer(const Scene& scene) : tracer_(tracing::makeEmbreeTracer(scene)) {}

  tracing::Hit closestHit(const tracing::Ray& ray) const override {
    const tracing::Hit hit = tracer_->closestHit(ray);
    tell(ray, hit ? hit.t : ray.tFar);
    return hit;
  }
  bool occluded(const tracing::Ray& ray) const override { return tracer_->occluded(ray); }
  Rgb transmittance(const tracing::Ray& ray) const override {
    tell(ray, ray.tFar);
    return tracer_->transmittance(ray);
  }
  tracing::Passing passing(const tracing::Ray& ray) const override { return tracer_->passing(ray); }
  tracing::GroupId separate(std::span<const PrimitiveId> primitives) override { return tracer_->separate(primitives); }
  void rebuild(tracing::GroupId group) override { tracer_->rebuild(group); }
  void rejoin() override { tracer_->rejoin(); }
  Rgb transmittance(const tracing::Ray& ray, tracing::GroupId group) const override {
    return tracer_->transmittance(ray, group);
  }

  mutable std::vector<lines::LineSegment> rays;  // as far as what they found

 private:
  void tell(const tracing::Ray& ray, float length) const {
    const std::scoped_lock lock(mutex_);
    rays.push_back({ray.origin, ray.direction, length});
  }

  std::unique_ptr<tracing::RayTracer> tracer_;
  mutable std::mutex mutex_;
};

/// A room of two parts, with a small closed box, a wide flat one, a mirror and a pane.
Scene roomWithHollows(bool lamp = true) {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.6f));
  addBox(scene, white, Vec3(0), {4, 4, 3}, true);
  addBox(scene, white, {1, 1, 0.5}, {1.1, 1.1, 0.6}, false);
  addBox(scene, white, {2, 2, 0.5}, {3.5, 3.5, 0.52}, false);
  addPolygon(scene, addMaterial(scene, "silver", Mirror{Rgb(0.8f)}),
             {{0.1, 1, 1}, {0.1, 2, 1}, {0.1, 2, 2}, {0.1, 1, 2}});
  addPolygon(scene, addMaterial(scene, "pane", ThinGlass{Rgb(0.9f), 1.52f}),
             {{2, 0, 0}, {2, 4, 0}, {2, 4, 3}, {2, 0, 3}});
  if (lamp) addLight(scene, PointLight{{3, 1, 2.5}, Rgb(1.0f)});
  return scene;
}

/// A scene and the walks of its sides.
class Walked {
 public:
  explicit Walked(Scene s, const lines::WalksHold& hold = lines::nothingHolds, std::vector<LightWalks> before = {},
                  std::span<const char> movedLights = {})
      : scene(std::move(s)),
        tracer(scene),
        responses(scene, true),
        lines(scene, tracer, responses),
        elements(hierarchy::buildElements(scene, hierarchy::surfaceSides(scene))),
        walks(std::move(before)),
        rays(lines::walkForLight(elements, lines, hold, movedLights, walks)) {}

  const LightWalks& of(std::size_t primitive, bool front) const {
    return walks[elements.side(PrimitiveId(primitive), 0, front).index()];
  }

  Scene scene;
  ToldTracer tracer;
  lines::SurfaceResponses responses;
  lines::LineTracer lines;
  hierarchy::Elements elements;
  std::vector<LightWalks> walks;
  std::uint64_t rays;
};

constexpr std::size_t kRoom = 0, kBox = 6, kFlat = 12, kEnd = 18;  // primitives

TEST(EnclosedSides, AreThoseInsideOfSmallClosedThings) {
  const Walked x(roomWithHollows());
  for (std::size_t i = kRoom; i < kEnd; ++i) EXPECT_FALSE(x.of(i, true).enclosed) << i;   // the lamp is seen
  for (std::size_t i = kRoom; i < kBox; ++i) EXPECT_FALSE(x.of(i, false).enclosed) << i;  // outside there is nothing
  for (std::size_t i = kBox; i < kFlat; ++i) EXPECT_TRUE(x.of(i, false).enclosed) << i;
}

TEST(EnclosedSides, AreNoneOfARoomWithoutALamp) {
  const Walked x(roomWithHollows(false));
  for (std::size_t i = kRoom; i < kBox; ++i) EXPECT_FALSE(x.of(i, true).enclosed) << i;  // it is too wide
  for (std::size_t i = kBox; i < kFlat; ++i) EXPECT_TRUE(x.of(i, false).enclosed) << i;
}

/// An edge shows a quarter of its cylinder, a corner an eighth of its ball; all else of them lies inside.
TEST(EnclosedSides, AreNoneOfARoundedBoxSeenFromOutside) {
  const TempFolder folder;
  const std::filesystem::path file =
      folder.write("s.rad",
                   "void plastic white\n0\n0\n5 .6 .6 .6 0 0\n"
                   "void light glow\n0\n0\n3 10 10 10\n"
                   "!genbox white room 5 4 3 -i\n"
                   "glow sphere lamp\n0\n0\n4 2 2 2.8 .05\n"
                   "!genbox white cushion .62 .4 .14 -r .06 | xform -t 1 1 .5 -a 4 -t .9 0 0 -a 2 -t 0 1 .3\n");
  const Walked x(loadScene({file}).scene);
  int rounded = 0;
  for (std::size_t i = 0; i < x.scene.primitives.size(); ++i) {
    if (std::holds_alternative<Polygon>(x.scene.primitives[i].shape)) continue;
    ++rounded;
    EXPECT_FALSE(x.of(i, true).enclosed) << i;
  }
  EXPECT_EQ(rounded, 8 * 20 + 1);
}

TEST(EnclosedSides, OpenWithTheHollow) {
  Scene scene = roomWithHollows();
  Scene open = scene;
  // The box has no lid.
  std::size_t lid = kBox;
  for (std::size_t i = kBox; i < kFlat; ++i)
    if (bounds(scene.primitives[i].shape).lower.z > 0.59) lid = i;
  open.primitives.erase(open.primitives.begin() + static_cast<std::ptrdiff_t>(lid));
  const Walked x(std::move(open));
  for (std::size_t i = kBox; i + 1 < kFlat; ++i) EXPECT_FALSE(x.of(i, false).enclosed) << i;
}

/// What is decided by lamps does not depend on how they are dimmed.
TEST(EnclosedSides, AreNoneWhereALampIsOff) {
  Scene scene = roomWithHollows();
  addLight(scene, PointLight{{1.05, 1.05, 0.55}, Rgb(1.0f)});
  scene.lights.back().scale = Rgb(0.0f);
  const Walked x(std::move(scene));
  for (std::size_t i = kBox; i < kFlat; ++i) EXPECT_FALSE(x.of(i, false).enclosed) << i;
}

TEST(LightWalks, ThatHoldStay) {
  Walked fresh(roomWithHollows());
  const hierarchy::ElementId side = fresh.elements.side(PrimitiveId(kRoom), 0, true);
  std::vector<LightWalks> before = fresh.walks;
  before[side.index()] = {{{Vec3f(1, 2, 3), Vec3f(0, 0, 1), 4}}, {}, true, {}, {}};  // what no walk would find
  const auto hold = [&](hierarchy::ElementId e, const LightWalks&) { return e == side; };
  const Walked some(roomWithHollows(), hold, before);
  EXPECT_LT(some.rays, fresh.rays);
  ASSERT_EQ(some.walks[side.index()].steps.size(), 1u);
  EXPECT_EQ(some.walks[side.index()].steps[0].from, Vec3f(1, 2, 3));
  EXPECT_TRUE(some.walks[side.index()].enclosed);
  for (std::size_t e = 0; e < fresh.walks.size(); ++e)
    if (e != side.index()) {
      EXPECT_EQ(some.walks[e].enclosed, fresh.walks[e].enclosed);
    }
  const std::vector<LightWalks> all = fresh.walks;
  const Walked nothing(
      roomWithHollows(), [](hierarchy::ElementId, const LightWalks&) { return true; }, all);
  EXPECT_EQ(nothing.rays, 0u);
  EXPECT_TRUE(nothing.tracer.rays.empty());
  for (std::size_t e = 0; e < all.size(); ++e) {
    EXPECT_EQ(nothing.walks[e].enclosed, all[e].enclosed);
    EXPECT_EQ(nothing.walks[e].steps.size(), all[e].steps.size());
  }
}

/// Whether a small box about a point is where walks are known to have run.
bool touched(const LightWalks& walks, const Vec3f& p) {
  Scene one;
  addBox(one, addMaterial(one, "white", lambert(0.5f)), Vec3(p) - 1e-3, Vec3(p) + 1e-3, false);
  std::vector<SceneChange::Moved> moved;
  for (std::size_t i = 0; i < one.primitives.size(); ++i)
    moved.push_back({PrimitiveId(i), {}, bounds(one.primitives[i].shape)});
  return !change::holdWalks(change::MovedSpace(one, moved), walks);
}

/// Two lamps; the second is somewhere.
Scene roomWithLampAt(const Vec3& at) {
  Scene scene = roomWithHollows();
  addLight(scene, PointLight{at, Rgb(1.0f)});
  return scene;
}

TEST(LightWalks, LookForTheLampThatMovedAlone) {
  const lines::WalksHold all = [](hierarchy::ElementId, const LightWalks&) { return true; };
  const std::vector<char> moved = {0, 1};
  const Vec3 outside(1, 3, 2), inTheBox(1.05, 1.05, 0.55), elsewhere(3, 3, 1);
  std::vector<LightWalks> known = Walked(roomWithLampAt(outside)).walks;
  std::size_t opened = 0;
  for (const Vec3& at : {elsewhere, inTheBox, outside, inTheBox, elsewhere}) {
    const Walked fresh(roomWithLampAt(at)), now(roomWithLampAt(at), all, known, moved);
    for (std::size_t e = 0; e < fresh.walks.size(); ++e) EXPECT_EQ(now.walks[e].enclosed, fresh.walks[e].enclosed) << e;
    EXPECT_LT(static_cast<double>(now.rays), 0.7 * static_cast<double>(fresh.rays));
    opened += !now.of(kBox, false).enclosed;
    known = now.walks;
  }
  EXPECT_EQ(opened, 2u);
}

TEST(LightWalks, HoldEveryRayThatWasAsked) {
  const Walked x(roomWithHollows());
  // Of one side at a time, so that all rays are its own.
  std::size_t rays = 0, boxes = 0, steps = 0;
  for (const hierarchy::ElementId side : x.elements.inputs) {
    if (!x.elements.receives(side)) continue;
    const Walked one(roomWithHollows(), [&](hierarchy::ElementId e, const LightWalks&) { return e != side; });
    const LightWalks& walks = one.walks[side.index()];
    (walks.steps.empty() ? boxes : steps) += 1;
    for (const lines::LineSegment& ray : one.tracer.rays)
      for (const float t : {0.0f, 0.31f, 0.77f, 1.0f}) {
        const Vec3f p = ray.from + t * std::min(ray.length, 50.0f) * ray.direction;
        EXPECT_TRUE(touched(walks, p)) << side.index();
        ++rays;
      }
  }
  EXPECT_GT(rays, 1000u);
  EXPECT_GT(boxes, 5u);
  EXPECT_GT(steps, 5u);
}

TEST(LightWalks, ThatHoldAreThoseThereWouldBe) {
  // A thing is put into the room, here and there.
  Walked before(roomWithHollows());
  Rng random(4);
  std::size_t held = 0, all = 0;
  for (int round = 0; round < 12; ++round) {
    Scene scene = roomWithHollows();
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 at(3.4 * x, 3.4 * y, 2.4 * z);
    addBox(scene, MaterialId(0u), at, at + 0.3 + 0.3 * random.uniform(), false);
    std::vector<SceneChange::Moved> moved;
    for (std::size_t i = before.scene.primitives.size(); i < scene.primitives.size(); ++i)
      moved.push_back({PrimitiveId(i), {}, bounds(scene.primitives[i].shape)});
    const change::MovedSpace space(scene, moved);
    const Walked after(std::move(scene));
    for (std::size_t i = 0; i < before.scene.primitives.size(); ++i)
      for (const bool front : {true, false}) {
        if (!before.elements.side(PrimitiveId(i), 0, front).valid()) continue;
        const LightWalks &was = before.of(i, front), &is = after.of(i, front);
        ++all;
        if (!change::holdWalks(space, was)) continue;
        ++held;
        ASSERT_EQ(is.enclosed, was.enclosed) << round << ": " << i;
        ASSERT_EQ(is.steps.size(), was.steps.size()) << round << ": " << i;
        for (std::size_t s = 0; s < is.steps.size(); ++s) {
          EXPECT_EQ(is.steps[s].from, was.steps[s].from);
          EXPECT_EQ(is.steps[s].direction, was.steps[s].direction);
          EXPECT_EQ(is.steps[s].length, was.steps[s].length);
        }
        EXPECT_EQ(is.box.lower, was.box.lower);
        EXPECT_EQ(is.box.upper, was.box.upper);
      }
  }
  EXPECT_GT(held, all / 5);
  EXPECT_LT(held, all);
}

}  // namespace
}  // namespace deltalux
