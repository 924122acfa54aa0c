// What passes a segment: panes of thin glass and uncovered parts multiply, everything else blocks.
#include <gtest/gtest.h>

#include "tracing/ray_tracer.hpp"
#include "tracing/test_scenes.hpp"

namespace deltalux {
using namespace tracing;

namespace {

constexpr int kOpaque = 0, kPane = 1;

const ThinGlass& glass(const Scene& scene) { return std::get<ThinGlass>(scene.materials[kPane].surface); }

Ray rayTo(const Vec3& from, const Vec3& to) {
  Ray ray;
  ray.origin = Vec3f(from);
  ray.direction = Vec3f(glm::normalize(to - from));
  return ray;
}

void expectNear(const Rgb& a, const Rgb& b) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-5f * std::max(b[k], 1e-3f));
}

/// `count` squares of side 2 around the z axis, 1 apart.
Scene stackOfPanes(int count) {
  Scene scene = test::emptyScene();
  for (int i = 0; i < count; ++i) {
    const double z = i;
    test::addPolygon(scene, {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}, kPane);
  }
  return scene;
}

TEST(Passage, ProductOverPanes) {
  for (const int count : {1, 2, 8, 9, 30}) {
    const Scene scene = stackOfPanes(count);
    const auto tracer = makeEmbreeTracer(scene);
    const Ray ray = rayTo({0.1, 0.2, -5}, {0.2, 0.1, count});
    Rgb expected(1.0f);
    for (int i = 0; i < count; ++i) expected *= transmittance(glass(scene), std::abs(double(ray.direction.z)));
    expectNear(tracer->transmittance(ray), expected);
    EXPECT_FALSE(tracer->occluded(ray));
    EXPECT_TRUE(tracer->closestHit(ray)) << "a pane is a surface all the same";
  }
}

/// passing() lets through what transmittance() does, and what it names as a blocker blocks by itself.
TEST(Passage, BlockersBlock) {
  Scene scene = test::randomScene(60, {0, 0, 0}, 2, 1, 5);
  for (std::size_t i = 0; i < scene.primitives.size(); i += 3) scene.primitives[i].material = MaterialId(kPane);
  const std::unique_ptr<RayTracer> tracers[] = {makeEmbreeTracer(scene), makeBruteForceTracer(scene)};
  std::vector<std::unique_ptr<RayTracer>> alone;
  std::vector<Scene> scenes(scene.primitives.size(), test::emptyScene());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    scenes[i].primitives.push_back(scene.primitives[i]);
    alone.push_back(makeBruteForceTracer(scenes[i]));
  }
  Rng rng(3);
  for (const auto& tracer : tracers) {
    int blocked = 0;
    for (int i = 0; i < 3000; ++i) {
      const Box space{Vec3(-3), Vec3(3)};
      const Vec3 from = test::randomIn(space, rng), to = test::randomIn(space, rng);
      Ray ray = rayTo(from, to);
      ray.tFar = static_cast<float>(glm::distance(from, to));
      const Passing passing = tracer->passing(ray);
      EXPECT_EQ(passing.share, tracer->transmittance(ray));
      EXPECT_EQ(passing.blocker.valid(), isBlack(passing.share));
      if (!passing.blocker.valid()) continue;
      ++blocked;
      EXPECT_TRUE(isBlack(alone[passing.blocker.index()]->transmittance(ray)));
    }
    EXPECT_GT(blocked, 500);
  }
}

TEST(Passage, PaneCountsOnceOnTheEdgeBetweenItsTriangles) {
  const Scene scene = stackOfPanes(3);
  const auto tracer = makeEmbreeTracer(scene);
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    // In the plane of both diagonals' shadows: through the edge of all three panes, up to rounding.
    const double a = 2 * rng.uniform() - 1, b = 2 * rng.uniform() - 1, flip = i % 2 ? 1 : -1;
    const Ray ray = rayTo({a, flip * a, -1}, {b, flip * b, 2.5});
    const Rgb one = transmittance(glass(scene), std::abs(double(ray.direction.z)));
    expectNear(tracer->transmittance(ray), one * one * one);
  }
}

TEST(Passage, MeshPaneCountsOnceAtItsInnerEdges) {
  Scene scene = test::emptyScene();
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j) positions.emplace_back(i, j, 30);
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::uint32_t j = 0; j < 4; ++j) {
      triangles.push_back({5 * i + j, 5 * i + j + 5, 5 * i + j + 6});
      triangles.push_back({5 * i + j, 5 * i + j + 6, 5 * i + j + 1});
    }
  test::add(scene, *makeMesh(positions, triangles), kPane);
  const auto tracer = makeEmbreeTracer(scene);
  const Rgb one = transmittance(glass(scene), 1.0);
  for (int i = 1; i < 4; ++i)
    for (int j = 1; j < 4; ++j) {
      expectNear(tracer->transmittance(rayTo(Vec3(i, j, 0), Vec3(i, j, 31))), one);              // six triangles meet
      expectNear(tracer->transmittance(rayTo(Vec3(i + 0.5, j, 0), Vec3(i + 0.5, j, 31))), one);  // two
    }
}

TEST(Passage, OpaqueBlocksBeforeBetweenAndBehindPanes) {
  for (const double z : {-0.5, 0.5, 2.5}) {
    Scene scene = stackOfPanes(3);
    test::add(scene, Ring{{0, 0, z}, {0, 0, 1}, 0, 1}, kOpaque);
    const auto tracer = makeEmbreeTracer(scene);
    const Ray ray = rayTo({0.1, 0.2, -5}, {0.1, 0.2, 5});
    EXPECT_TRUE(tracer->occluded(ray));
    EXPECT_EQ(tracer->transmittance(ray), Rgb(0.0f));
    Ray before = ray;
    before.tFar = static_cast<float>(z + 5 - 0.01);
    EXPECT_FALSE(tracer->occluded(before));
    EXPECT_GT(tracer->transmittance(before).g, 0.5f);
  }
}

TEST(Passage, BlackPaneBlocks) {
  Scene scene = stackOfPanes(1);
  scene.materials[kPane].surface = ThinGlass{Rgb(0.0f), 1.52f};
  const auto tracer = makeEmbreeTracer(scene);
  EXPECT_EQ(tracer->transmittance(rayTo({0, 0, -1}, {0, 0, 1})), Rgb(0.0f));
}

TEST(Passage, WhatIsNotCoveredPassesAtEveryAngle) {
  Scene scene = stackOfPanes(3);
  scene.materials[kPane] = {"curtain", Opaque{Rgb(1.0f), {}, {}}, {}, 0.75f, Rgb(1.0f, 0.5f, 1.0f)};
  const std::unique_ptr<RayTracer> tracers[] = {makeEmbreeTracer(scene), makeBruteForceTracer(scene)};
  for (const auto& tracer : tracers)
    for (const Vec3& to : {Vec3(0, 0, 3), Vec3(0.9, 0.9, 3), Vec3(40, 0, 0.2)}) {
      const Ray ray = rayTo({0, 0, -1e-3}, to);
      const Rgb one(0.25f, 0.125f, 0.25f);
      expectNear(tracer->transmittance(ray), to.z > 2 ? one * one * one : one);
      EXPECT_FALSE(tracer->occluded(ray));
      EXPECT_FALSE(tracer->passing(ray).blocker.valid());
    }
}

TEST(Passage, RandomPanesAgreeWithBruteForce) {
  Scene scene = test::emptyScene();
  Rng rng(4);
  for (int i = 0; i < 72; ++i)
    test::add(scene, test::randomShape(i, test::randomIn({Vec3(-2), Vec3(2)}, rng), 1, rng),
              i % 4 == 3 ? kOpaque : kPane);
  const auto embree = makeEmbreeTracer(scene), bruteForce = makeBruteForceTracer(scene);
  const Box box = bounds(scene);
  int differ = 0, tinted = 0;
  for (int i = 0; i < 100000; ++i) {
    Ray ray = test::randomRay(scene, box, rng);
    ray.tNear = static_cast<float>(rng.uniform());
    ray.tFar = ray.tNear + static_cast<float>(6 * rng.uniform());
    const Rgb a = embree->transmittance(ray), b = bruteForce->transmittance(ray);
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(a[k] - b[k]) <= 1e-4f)) ++differ, k = 3;
    EXPECT_EQ(embree->occluded(ray) && !isBlack(a), false);
    tinted += b.r > 0 && b.r < 0.99f;
  }
  EXPECT_LE(differ, 3) << "edges within rounding";
  EXPECT_GT(tinted, 10000);
}

}  // namespace
}  // namespace deltalux
