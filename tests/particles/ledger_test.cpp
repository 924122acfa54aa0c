// The flux that particles take over comes out again, on every scene of ours: deposited, absorbed, escaped or cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include <deltalux/io.hpp>

#include "particles/particles.hpp"

namespace deltalux {
using namespace particles;

namespace {

class ParticleLedgers : public testing::TestWithParam<const char*> {};

TEST_P(ParticleLedgers, Close) {
  Scene scene = loadScene({std::string(DELTALUX_SOURCE_DIR "/scenes/") + GetParam()}).scene;
  addAreaLights(scene);
  const Particles p = traceParticles(scene, *tracing::makeEmbreeTracer(scene), {100000, 1, 64});
  ASSERT_NO_THROW(validate(p, scene));
  const ParticleLedger l = p.ledger();
  EXPECT_GT(l.entered + l.passed, 0);
  EXPECT_NEAR(l.residue() / (l.entered + l.passed), 0, 1e-3);
  EXPECT_LT(l.cut / (l.entered + l.passed), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Bundled, ParticleLedgers,
                         testing::Values("cornell-caustic/cornell-caustic.rad", "ring/ring.rad", "lodge/morning.rad",
                                         "lodge/night.rad", "street/day.rad", "street/night.rad",
                                         "nasty/nested_glass.rad", "nasty/mirror_corridor.rad"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace deltalux
