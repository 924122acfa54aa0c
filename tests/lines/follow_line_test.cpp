// Lines through panes, over mirrors and gloss: their mean is what the surfaces do.
#include "lines/follow_line.hpp"

#include <gtest/gtest.h>

#include "base/cosine_direction.hpp"
#include "base/sobol.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;
using lines::LineTermination;

struct Tally {
  double ended = 0, escaped = 0, absorbed = 0;  // of a unit that is sent, gray
};

/// What becomes of a unit of light from the floor point at the origin, upwards.
Tally sentUp(const Scene& scene, int count) {
  const auto tracer = tracing::makeEmbreeTracer(scene);
  const lines::SurfaceResponses responses(scene, true);
  const lines::LineTracer lines(scene, *tracer, responses);
  Tally t;
  for (int i = 0; i < count; ++i) {
    const UnitPair u = scrambledSobol(static_cast<std::uint32_t>(i), 1);
    const Vec3f w(cosineDirection(Frame(Vec3(0, 0, 1)), u.x, u.y));
    const lines::LineEnd end = lines.follow(Vec3f(0, 0, 0), {0, 0, 1}, w, Rng(7, static_cast<std::uint64_t>(i)));
    if (end.termination == LineTermination::Ended)
      t.ended += gray(end.weight) / responses.at(end.side.primitive, end.side.front).ends;
    if (end.termination == LineTermination::Escaped) t.escaped += gray(end.weight);
    t.absorbed += gray(end.absorbed);
  }
  t.ended /= count, t.escaped /= count, t.absorbed /= count;
  return t;
}

Scene under(const Surface& surface, float coverage = 1) {
  Scene scene;
  const MaterialId lid = addMaterial(scene, "lid", surface);
  scene.materials[lid.index()].coverage = coverage;
  addPolygon(scene, lid, {{-100, -100, 1}, {-100, 100, 1}, {100, 100, 1}, {100, -100, 1}});  // faces down
  return scene;
}

TEST(FollowLine, EndsOnWhatIsDiffuse) {
  const Tally t = sentUp(under(lambert(0.5f)), 4096);
  EXPECT_NEAR(t.ended, 1, 2e-3);
  EXPECT_EQ(t.absorbed, 0);
}

TEST(FollowLine, AMirrorSendsOnWhatItReflects) {
  const Tally t = sentUp(under(Mirror{Rgb(0.8f)}), 4096);
  EXPECT_NEAR(t.escaped, 0.8, 5e-3);  // below there is nothing
  EXPECT_NEAR(t.absorbed, 0.2, 5e-3);
  EXPECT_EQ(t.ended, 0);
}

TEST(FollowLine, APanePassesReflectsAndAbsorbs) {
  const Tally t = sentUp(under(ThinGlass{Rgb(0.9f), 1.52f}), 1 << 16);
  EXPECT_NEAR(t.escaped + t.absorbed, 1, 5e-3);
  EXPECT_GT(t.absorbed, 0.05);
}

TEST(FollowLine, GlossShowsItsDiffusePartAndGoesOn) {
  const Opaque gloss{Rgb(0.3f), {}, {Rgb(0.5f), 0.0f, SpecularLobe::Distribution::Ward}};
  const Tally t = sentUp(under(gloss), 1 << 16);
  EXPECT_NEAR(t.ended, 1, 1e-2);      // all of it arrives there
  EXPECT_NEAR(t.escaped, 0.5, 1e-2);  // and half of it goes on
  EXPECT_EQ(t.absorbed, 0);           // which its leaf accounts for
}

TEST(FollowLine, CoverageLetsTheRestPass) {
  const Tally t = sentUp(under(lambert(0.5f), 0.75f), 1 << 15);
  EXPECT_NEAR(t.escaped, 0.25, 1e-2);
  EXPECT_NEAR(t.ended, 1, 2e-2);  // irradiance of the whole side
}

}  // namespace
}  // namespace deltalux
