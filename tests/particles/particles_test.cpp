// Particles are a function of the scene, the seed and the target count alone, and their flux is accounted for.
#include "particles/particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/parallel.hpp"
#include "paper/coarse_solution.hpp"
#include "particles/count_paths.hpp"
#include "particles/trace.hpp"
#include "particles/transfer.hpp"
#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

/// A room with a lamp, a sunlit window of glass, a mirror, a metal ball, a glass ball and a glossy floor.
Scene room(float lampScale = 1.0f, float wallColour = 0.6f) {
  Scene scene;
  const MaterialId wall = test::addMaterial(scene, "wall", test::lambert(wallColour));
  test::addBox(scene, wall, {0, 0, 0}, {4, 3, 2.5}, true);
  Opaque glossy = test::lambert(0.3f);
  glossy.specular = {Rgb(0.1f, 0.2f, 0.3f), 0.1f, SpecularLobe::Distribution::Ward};
  test::addPolygon(scene, test::addMaterial(scene, "tiles", glossy),
                   {{1, 1, 0.01}, {3, 1, 0.01}, {3, 2, 0.01}, {1, 2, 0.01}});
  test::addPolygon(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
                   {{3.99, 1, 1}, {3.99, 1, 2}, {3.99, 2, 2}, {3.99, 2, 1}});
  test::addPolygon(scene, test::addMaterial(scene, "pane", ThinGlass{Rgb(0.95f), 1.52f}),
                   {{1, 0.5, 0.5}, {2, 0.5, 0.5}, {2, 0.5, 1.5}, {1, 0.5, 1.5}});
  Opaque metal;
  metal.specular = {Rgb(0.8f, 0.6f, 0.3f), 0.0f, SpecularLobe::Distribution::Ward};
  test::addShape(scene, test::addMaterial(scene, "metal", metal), Sphere{{1, 2.2, 0.4}, 0.3});
  test::addShape(scene, test::addMaterial(scene, "glass", Dielectric{Rgb(0.9f), 1.5f}), Sphere{{2.5, 1.2, 0.6}, 0.25});
  const MaterialId lamp = test::addMaterial(scene, "lamp", Opaque{}, Emission{Rgb(20.0f), false, {}});
  test::addPolygon(scene, lamp, {{1.5, 1, 2.4}, {1.5, 1.6, 2.4}, {2.1, 1.6, 2.4}, {2.1, 1, 2.4}});
  test::addLight(scene, PointLight{{3, 2.5, 2}, Rgb(3.0f)});
  addAreaLights(scene);
  scene.lights.back().scale = Rgb(lampScale);
  return scene;
}

Particles trace(const Scene& scene, std::uint64_t count = 20000, std::uint64_t seed = 1) {
  const auto tracer = tracing::makeEmbreeTracer(scene);
  ParticleSettings settings;
  settings.count = count, settings.seed = seed;
  Particles p = traceParticles(scene, *tracer, settings);
  validate(p, scene);
  return p;
}

TEST(Particles, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = room();
  std::uint64_t hash = 0;
  for (const std::size_t threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    const Particles p = trace(scene);
    EXPECT_GT(p.impacts(), 10000u);
    if (hash != 0) {
      EXPECT_EQ(p.hash(), hash);
    }
    hash = p.hash();
  }
  EXPECT_NE(trace(scene, 20000, 2).hash(), hash);
}

TEST(Particles, TwiceAsManyContainTheOthers) {
  const Scene scene = room();
  const Particles few = trace(scene, 20000), many = trace(scene, 40000);
  std::map<std::uint64_t, std::size_t> byKey;
  for (std::size_t l = 0; l < many.links.size(); ++l) byKey[many.links[l].key] = l;
  for (const ParticleLink& l : few.links) {
    ASSERT_TRUE(byKey.contains(l.key));
    const ParticleLink& m = many.links[byKey[l.key]];
    ASSERT_GE(m.paths, l.paths);
    for (std::uint32_t k = 0; k < l.paths; ++k) {
      const std::uint32_t a = l.firstPath + k, b = m.firstPath + k;
      ASSERT_TRUE(std::ranges::equal(few.verticesOf(a), many.verticesOf(b)));
      ASSERT_EQ(few.range[a].impacts, many.range[b].impacts);
      for (std::uint32_t i = 0; i < few.range[a].impacts; ++i)
        ASSERT_EQ(few.throughput[few.firstImpact(a) + i], many.throughput[many.firstImpact(b) + i]);
    }
  }
  EXPECT_NEAR(double(few.arrived()), 20000, 6000);
  EXPECT_NEAR(double(many.arrived()) / double(few.arrived()), 2.0, 0.1);
}

TEST(Particles, DimmedLightsAndNewDiffuseColoursTraceNothingNew) {
  const std::uint64_t hash = trace(room()).hash();
  EXPECT_EQ(trace(room(0.2f)).hash(), hash);
  EXPECT_EQ(trace(room(0.0f)).hash(), hash);
  EXPECT_EQ(trace(room(1.0f, 0.3f)).hash(), hash);
}

TEST(Particles, LedgerCloses) {
  const Particles p = trace(room(), 200000);
  const ParticleLedger l = p.ledger();
  EXPECT_GT(l.entered, 0);
  EXPECT_GT(l.passed, 0);
  EXPECT_GT(l.absorbed, 0);
  EXPECT_NEAR(l.residue() / (l.entered + l.passed), 0, 1e-3);
  EXPECT_NEAR(l.escaped / l.entered, 0, 1e-6);  // the room is closed
  EXPECT_EQ(p.cut(), 0u);
}

/// Mirrors face to face: paths end by chance, and the few that do not are counted.
TEST(Particles, LightCaughtBetweenMirrorsEnds) {
  Scene scene;
  const MaterialId mirror = test::addMaterial(scene, "mirror", Mirror{Rgb(1.0f)});
  test::addPolygon(scene, mirror, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::addPolygon(scene, mirror, {{0, 0, 0.1}, {0, 1, 0.1}, {1, 1, 0.1}, {1, 0, 0.1}});
  test::addLight(scene, PointLight{{0.5, 0.5, 0.05}, Rgb(1.0f)});
  const auto tracer = tracing::makeEmbreeTracer(scene);
  ParticleSettings settings;
  settings.count = 5000, settings.maxDepth = 24;
  const Particles p = traceParticles(scene, *tracer, settings);
  EXPECT_GT(p.cut(), 0u);
  const ParticleLedger l = p.ledger();
  EXPECT_EQ(l.passed, 0);
  EXPECT_EQ(l.deposited, 0);
  EXPECT_NEAR((l.escaped + l.cut + l.residue()) / l.entered, 1.0, 1e-3);
  EXPECT_NEAR(l.residue() / l.entered, 0.0, 0.02);
}

TEST(Particles, DepositKeepsTheirFlux) {
  const Scene scene = room();
  const auto tracer = tracing::makeEmbreeTracer(scene);
  const Particles p = trace(scene, 50000);
  hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
  for (std::size_t i = 0; i < elements.size(); ++i) elements.radiometry[i].B = Rgb(2.0f);
  const ParticleTransfer transfer(p, elements, scene);
  transfer.apply(elements, scene::scalesOf(scene));
  RgbSum transferred(0.0), deposited(0.0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements.isReceivingLeaf(hierarchy::ElementId(i)))
      transferred += double(elements.geometry[i].area) * RgbSum(elements.radiometry[i].particle);
  }
  for (const Impact& i : impacts(p, elements, scene)) deposited += RgbSum(i.flux);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(transferred[c] / deposited[c], 1.0, 1e-4);
  EXPECT_EQ(transfer.lost(), 0);
}

/// A path is its link's key and its number: where its link stands among the others does not matter.
TEST(Particles, OrderOfLinksDoesNotMatter) {
  const Scene scene = room();
  const auto tracer = tracing::makeEmbreeTracer(scene);
  const Particles p = trace(scene, 5000);
  const scene::LightSampler lights(scene);
  Senders senders(scene, lights);
  const Receivers receivers(scene);
  std::vector<float> strength(p.nominal);
  senders.weigh(strength);
  const ParticleEmission emission(scene, *tracer, senders, receivers);
  DsLinks links;
  for (const ParticleLink& l : p.links) links.all.push_back({l.ends, l.key, static_cast<float>(l.paths), 1.0f});
  const auto paths = [&] {
    Particles q;
    q.senderCells = senders.cells(), q.nominal = strength;
    countPaths(links, double(p.paths()), q);
    tracePaths(scene, *tracer, emission, 64, q);
    std::map<std::pair<std::uint64_t, std::uint32_t>, std::vector<Vec3f>> byName;
    for (std::size_t i = 0; i < q.paths(); ++i) {
      const ParticleLink& l = q.links[q.link[i]];
      const auto v = q.verticesOf(i);
      byName[{l.key, static_cast<std::uint32_t>(i - l.firstPath)}].assign(v.begin(), v.end());
    }
    return byName;
  };
  const auto first = paths();
  std::reverse(links.all.begin(), links.all.end());
  EXPECT_EQ(paths(), first);
  EXPECT_GT(first.size(), 5000u);
}

TEST(Particles, NoneWithoutSpeculars) {
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "wall", test::lambert(0.5f)), {0, 0, 0}, {1, 1, 1}, true);
  test::addLight(scene, PointLight{{0.5, 0.5, 0.5}, Rgb(1.0f)});
  EXPECT_EQ(trace(scene).paths(), 0u);
}

}  // namespace
}  // namespace deltalux
