#include <gtest/gtest.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <deltalux/scene.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.hpp"
#include "tracing/ray_tracer.hpp"
#include "tracing/test_scenes.hpp"

namespace deltalux {
using namespace tracing;

namespace {

bool same(const Hit& a, const Hit& b) {
  return a.t == b.t && a.primitive == b.primitive && a.triangle == b.triangle && a.position == b.position &&
         a.normal == b.normal && a.front == b.front;
}

std::vector<Ray> randomRays(const Scene& scene, std::size_t count) {
  std::vector<Ray> rays(count);
  const Box box = bounds(scene);
  Rng rng(17);
  for (Ray& ray : rays) ray = test::randomRay(scene, box, rng);
  return rays;
}

Vec3f hemisphereDirection(const Vec3& normal, Rng& rng) {
  const Vec3 d = test::randomDirection(rng);
  return Vec3f(glm::dot(d, normal) < 0 ? -d : d);
}

TEST(RayTracer, HitsLieOnTheirPrimitive) {
  const Scene scene = test::randomScene(90, {20, 10, 5}, 3, 1, 1);
  const auto tracer = makeEmbreeTracer(scene);
  for (const Ray& ray : randomRays(scene, 20000)) {
    const Hit hit = tracer->closestHit(ray);
    if (!hit) continue;
    const Shape& shape = scene[hit.primitive].shape;
    const SurfacePoint p = pointAt(shape, parameterAt(shape, Vec3(hit.position), hit.triangle));
    EXPECT_LT(glm::distance(p.position, Vec3(hit.position)), 3e-6);
    EXPECT_LT(glm::distance(at(ray, hit.t), hit.position), 1e-5);
    EXPECT_GT(glm::dot(Vec3(hit.normal), p.normal), 1 - 1e-4);
    EXPECT_EQ(hit.front, glm::dot(hit.normal, ray.direction) < 0);
    EXPECT_NEAR(glm::length(hit.normal), 1, 1e-6);
  }
}

TEST(RayTracer, RaysFromASurfaceDoNotMeetItAgain) {
  for (const auto& named : test::nastyScenes()) {
    const Scene& scene = named.scene;
    const auto tracer = makeEmbreeTracer(scene);
    Rng rng(5);
    int again = 0, escaped = 0;
    for (int i = 0; i < 20000; ++i) {
      const PrimitiveId id(static_cast<std::size_t>(rng.uniform() * double(scene.primitives.size())));
      const Shape& shape = scene[id].shape;
      const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
      Ray ray;
      ray.direction = hemisphereDirection(p.normal, rng);
      ray.origin = offsetOrigin(Vec3f(p.position), Vec3f(p.normal), ray.direction);
      const Hit hit = tracer->closestHit(ray);
      const auto* sphere = std::get_if<Sphere>(&shape);
      const bool flat = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Ring>(shape);
      if ((flat && !named.ties) || (sphere && !sphere->inward)) again += hit.primitive == id;
      // From within, a sphere is met again on its far side, never passed.
      if (sphere && sphere->inward) escaped += !hit || hit.t > 2.001 * sphere->radius;
    }
    EXPECT_EQ(again, 0) << named.name;
    EXPECT_EQ(escaped, 0) << named.name;
  }
}

TEST(RayTracer, RaysThatStartInAPlaneEnd) {
  // Without an offset, on polygons whose planes round to the ray's own coordinates and off them by a digit; also on
  // threads that take denormal numbers for zero, as Embree asks its callers to.
  const unsigned mode = _mm_getcsr();
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  Scene scene = test::emptyScene();
  test::addBox(scene, {{-1, -2, 0.228529}, {9, 20, 3}});
  test::addBox(scene, {{0.1, 0.30001, 0.228529}, {0.4, 0.60003, 0.5}});
  const auto tracer = makeEmbreeTracer(scene);
  Rng rng(9);
  for (int i = 0; i < 100000; ++i) {
    const PrimitiveId id(static_cast<std::size_t>(rng.uniform() * double(scene.primitives.size())));
    const SurfacePoint p = samplePoint(scene[id].shape, {rng.uniform(), rng.uniform()});
    Ray ray;
    ray.origin = Vec3f(p.position) + static_cast<float>(i % 5 - 2) * 1e-7f * Vec3f(p.normal);
    ray.direction = Vec3f(test::randomDirection(rng));
    const Hit hit = tracer->closestHit(ray);
    EXPECT_GE(hit.t, 0.0f);
    if (hit.primitive == id) {
      EXPECT_LT(hit.t * std::abs(glm::dot(hit.normal, ray.direction)), 4e-6f) << "one plane is met once";
    }
  }
  _mm_setcsr(mode);
}

TEST(RayTracer, NothingLeavesASealedBox) {
  Scene scene = test::emptyScene();
  test::addBox(scene, {{-1, -2, -3}, {3, 2, 1}}, test::someTurn());
  const auto tracer = makeEmbreeTracer(scene);
  Rng rng(6);
  for (int path = 0; path < 2000; ++path) {
    Ray ray;
    ray.origin = Vec3f(test::someTurn() * test::randomIn({{-0.9, -1.9, -2.9}, {2.9, 1.9, 0.9}}, rng));
    ray.direction = Vec3f(test::randomDirection(rng));
    for (int bounce = 0; bounce < 50; ++bounce) {
      const Hit hit = tracer->closestHit(ray);
      ASSERT_TRUE(hit) << "path " << path << " bounce " << bounce;
      ASSERT_FALSE(hit.front) << "faces look outwards";
      ray.direction = hemisphereDirection(-Vec3(hit.normal), rng);
      ray.origin = offsetOrigin(hit.position, hit.normal, ray.direction);
    }
  }
}

TEST(RayTracer, MirrorCorridorKeepsItsRays) {
  Scene scene = test::emptyScene();
  test::addPolygon(scene, {{0, 0, 0}, {1000, 0, 0}, {1000, 0, 1000}, {0, 0, 1000}});
  test::addPolygon(scene, {{0, 0.01, 0}, {0, 0.01, 1000}, {1000, 0.01, 1000}, {1000, 0.01, 0}});
  const auto tracer = makeEmbreeTracer(scene);
  Ray ray;
  ray.origin = Vec3f(300, 0.005f, 300);
  ray.direction = glm::normalize(Vec3f(0.3f, 1, -0.2f));
  PrimitiveId last;
  for (int bounce = 0; bounce < 2000; ++bounce) {
    const Hit hit = tracer->closestHit(ray);
    ASSERT_TRUE(hit);
    ASSERT_NE(hit.primitive, last) << bounce;
    last = hit.primitive;
    ray.direction = glm::normalize(ray.direction - 2 * glm::dot(ray.direction, hit.normal) * hit.normal);
    ray.origin = offsetOrigin(hit.position, hit.normal, ray.direction);
  }
}

TEST(RayTracer, TellsSheetsAThousandthApart) {
  // From each sheet the next one is the next: at coordinates of 30 units, and 1 mm apart at 1 m.
  Scene scene = test::emptyScene();
  for (int i = 0; i < 10; ++i) {
    const double z = 30 + 1e-3 * i, x = 1 + 1e-3 * i;
    test::addPolygon(scene, {{28, 28, z}, {32, 28, z}, {32, 32, z}, {28, 32, z}});
    test::addPolygon(scene, {{x, 0, 0}, {x, 1, 0}, {x, 1, 1}, {x, 0, 1}});
  }
  const auto tracer = makeEmbreeTracer(scene);
  Rng rng(8);
  for (int i = 0; i < 20000; ++i) {
    const PrimitiveId id(static_cast<std::size_t>(rng.uniform() * 18));
    const SurfacePoint p = samplePoint(scene[id].shape, {0.1 + 0.8 * rng.uniform(), 0.1 + 0.8 * rng.uniform()});
    Ray ray;
    const Vec3 lean = 5.0 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    ray.direction = Vec3f(glm::normalize(p.normal + lean - glm::dot(lean, p.normal) * p.normal));
    ray.origin = offsetOrigin(Vec3f(p.position), Vec3f(p.normal), ray.direction);
    EXPECT_EQ(tracer->closestHit(ray).primitive, PrimitiveId(id.value + 2u));
  }
}

TEST(RayTracer, SegmentsIncludeTheirEnds) {
  Scene scene = test::emptyScene();
  test::addPolygon(scene, {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}});
  test::add(scene, Sphere{{0, 0, 5}, 1, false});
  for (const auto& tracer : {makeEmbreeTracer(scene), makeBruteForceTracer(scene)}) {
    Ray ray;
    ray.origin = Vec3f(0.2f, 0.1f, 0);
    ray.tFar = 2;
    EXPECT_EQ(tracer->closestHit(ray).primitive, PrimitiveId(0));
    EXPECT_TRUE(tracer->occluded(ray));
    ray.tFar = 1.999f;
    EXPECT_FALSE(tracer->closestHit(ray));
    EXPECT_FALSE(tracer->occluded(ray));
    ray.tNear = 2.001f, ray.tFar = 100;
    EXPECT_EQ(tracer->closestHit(ray).primitive, PrimitiveId(1));
    EXPECT_TRUE(tracer->closestHit(ray).front);
    ray.tNear = 5;
    EXPECT_FALSE(tracer->closestHit(ray).front) << "the sphere's far side, from within";
    ray.tNear = 7;
    EXPECT_EQ(tracer->transmittance(ray), Rgb(1.0f));
  }
}

TEST(RayTracer, BatchesAreSinglesOnAnyNumberOfThreads) {
  const Scene scene = test::randomScene(90, {0, 0, 0}, 2, 1, 3);
  const std::vector<Ray> rays = randomRays(scene, 20000);
  const auto reference = makeEmbreeTracer(scene);
  for (const std::size_t threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const auto tracer = makeEmbreeTracer(scene);
    std::vector<Hit> hits(rays.size());
    std::vector<Rgb> passed(rays.size());
    tracer->closestHits(rays, hits);
    tracer->transmittances(rays, passed);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same(hits[i], reference->closestHit(rays[i])));
      ASSERT_EQ(passed[i], reference->transmittance(rays[i]));
    }
  }
}

TEST(RayTracer, CountsEveryQueryOnAnyNumberOfThreads) {
  const Scene scene = test::randomScene(20, {0, 0, 0}, 2, 1, 3);
  const std::vector<Ray> rays = randomRays(scene, 5000);
  for (const std::size_t threads : {1, 5}) {
    const ThreadLimit limit(threads);
    for (const auto& tracer : {makeEmbreeTracer(scene), makeBruteForceTracer(scene)}) {
      EXPECT_EQ(tracer->traced(), 0u);
      std::vector<Hit> hits(rays.size());
      std::vector<Rgb> passed(rays.size());
      std::vector<Passing> passings(rays.size());
      tracer->closestHits(rays, hits);
      tracer->transmittances(rays, passed);
      tracer->passings(rays, passings);
      tracer->closestHits(std::span(rays).first(3), std::span(hits).first(3));
      EXPECT_EQ(tracer->traced(), 3 * rays.size() + 3);
      tracer->closestHit(rays[0]), tracer->occluded(rays[0]);
      tracer->transmittance(rays[0]), tracer->passing(rays[0]), tracer->transmittance(rays[0], GroupId(0));
      EXPECT_EQ(tracer->traced(), 3 * rays.size() + 8);
    }
  }
}

TEST(RayTracer, EmptySceneAndShapesWithoutExtent) {
  Scene scene = test::emptyScene();
  EXPECT_FALSE(makeEmbreeTracer(scene)->closestHit(Ray{}));
  test::add(scene, Polygon{});
  test::add(scene, Mesh{});
  test::add(scene, Sphere{{0, 0, 0}, 0, false});
  test::add(scene, Cylinder{{0, 0, 1}, {0, 0, 1}, 1, false});
  for (const auto& tracer : {makeEmbreeTracer(scene), makeBruteForceTracer(scene)}) {
    EXPECT_FALSE(tracer->closestHit(Ray{}));
    EXPECT_FALSE(tracer->occluded(Ray{}));
    EXPECT_EQ(tracer->transmittance(Ray{}), Rgb(1.0f));
  }
}

class Groups : public testing::Test {
 protected:
  /// The movable ones are every fifth primitive.
  Groups() : scene_(test::randomScene(90, {0, 0, 0}, 2, 1, 7)) {
    for (std::size_t i = 0; i < scene_.primitives.size(); i += 5) movable_.emplace_back(i);
  }

  void move(const Mat4& map) {
    for (const PrimitiveId id : movable_) {
      Shape& shape = scene_.primitives[id.index()].shape;
      shape = *transformed(shape, map);
    }
  }

  void expectSameAsFresh(const RayTracer& tracer) const {
    const auto fresh = makeEmbreeTracer(scene_);
    for (const Ray& ray : randomRays(scene_, 20000)) {
      ASSERT_TRUE(same(tracer.closestHit(ray), fresh->closestHit(ray)));
      ASSERT_EQ(tracer.occluded(ray), fresh->occluded(ray));
    }
  }

  Scene scene_;
  std::vector<PrimitiveId> movable_;
};

TEST_F(Groups, SeparatedAndMovedIsAFreshTracerBitForBit) {
  const auto tracer = makeEmbreeTracer(scene_);
  const GroupId group = tracer->separate(movable_);
  expectSameAsFresh(*tracer);
  for (int step = 0; step < 5; ++step) {
    move(glm::rotate(glm::translate(Mat4(1), Vec3(0.3, -0.2, 0.1)), 0.4, Vec3(0, 1, 1)));
    tracer->rebuild(group);
    expectSameAsFresh(*tracer);
  }
}

TEST(NastyGroups, CoincidentSurfacesAreHitAlikeHoweverTheyAreGrouped) {
  for (const auto& named : test::nastyScenes()) {
    const auto fresh = makeEmbreeTracer(named.scene), grouped = makeEmbreeTracer(named.scene);
    std::vector<PrimitiveId> movable;
    for (std::size_t i = 0; i < named.scene.primitives.size(); i += 3) movable.emplace_back(i);
    grouped->separate(movable);
    for (const Ray& ray : randomRays(named.scene, 10000)) {
      const Hit hit = fresh->closestHit(ray);
      // Along a plane single precision does not tell what lies in it.
      if (hit && std::abs(glm::dot(hit.normal, ray.direction)) < 5e-3f) continue;
      ASSERT_TRUE(same(hit, grouped->closestHit(ray))) << named.name;
    }
  }
}

/// Rays that pass an edge within single precision: which of its faces they meet, if any, must not depend on what else
/// is in the tree.
TEST(NastyGroups, EdgesAreHitAlikeHoweverTheyAreGrouped) {
  for (const bool turned : {false, true}) {
    Scene scene = test::emptyScene();
    Rng rng(8);
    test::addBox(scene, {{-1.3, -1.7, -1.1}, {1.9, 1.3, 1.7}}, turned ? test::someTurn() : glm::dmat3(1));
    std::vector<std::array<Vec3, 2>> edges;
    for (int i = 0; i < 60; ++i) {
      const Vec3 corner = test::randomIn({{-1.2, -1.6, -1.0}, {1.5, 1.0, 1.4}}, rng);
      test::addBox(scene, {corner, corner + test::randomIn({Vec3(0.02), Vec3(0.3)}, rng)},
                   turned ? test::someTurn() : glm::dmat3(1));
    }
    for (const Primitive& p : scene.primitives) {
      const auto& vertices = std::get<Polygon>(p.shape).vertices;
      for (std::size_t k = 0; k < vertices.size(); ++k)
        edges.push_back({vertices[k], vertices[(k + 1) % vertices.size()]});
    }
    const auto fresh = makeEmbreeTracer(scene), grouped = makeEmbreeTracer(scene);
    std::vector<PrimitiveId> movable;
    for (std::size_t i = 6; i < scene.primitives.size(); i += 4) movable.emplace_back(i);
    grouped->separate(movable);
    int differ = 0;
    for (int i = 0; i < 300000; ++i) {
      const auto& [a, b] = edges[static_cast<std::size_t>(rng.uniform() * double(edges.size()))];
      Ray ray;
      ray.origin = Vec3f(test::randomIn({{-1.2, -1.6, -1.0}, {1.8, 1.2, 1.6}}, rng));
      ray.direction = Vec3f(glm::normalize(glm::mix(a, b, rng.uniform()) - Vec3(ray.origin)));
      differ +=
          !same(fresh->closestHit(ray), grouped->closestHit(ray)) || fresh->occluded(ray) != grouped->occluded(ray);
    }
    EXPECT_EQ(differ, 0) << (turned ? "turned" : "along the axes");
  }
}

/// Rays that start on the outermost faces of a group, inside of it: the group is entered whatever is rounded.
TEST(NastyGroups, RaysFromTheRimOfAGroupAreItsOwn) {
  Rng rng(9);
  for (int i = 0; i < 200; ++i) {
    Scene scene = test::emptyScene();
    test::addBox(scene, {{-9, -9, -9}, {9, 9, 9}});
    const Vec3 corner = test::randomIn({Vec3(-7), Vec3(7)}, rng);
    const Box box{corner, corner + test::randomIn({Vec3(0.02), Vec3(1)}, rng)};
    test::addBox(scene, box);
    const auto fresh = makeEmbreeTracer(scene), grouped = makeEmbreeTracer(scene);
    std::vector<PrimitiveId> own;
    for (std::size_t p = 6; p < 12; ++p) own.emplace_back(p);
    grouped->separate(own);
    for (int k = 0; k < 500; ++k) {
      Vec3 at = test::randomIn(box, rng);
      const int axis = k % 3;
      at[axis] = k % 2 ? box.lower[axis] : box.upper[axis];
      Ray ray;
      ray.origin = Vec3f(at), ray.direction = Vec3f(test::randomDirection(rng));
      ASSERT_TRUE(same(fresh->closestHit(ray), grouped->closestHit(ray))) << "box " << i << " ray " << k;
      ASSERT_EQ(fresh->occluded(ray), grouped->occluded(ray)) << "box " << i << " ray " << k;
    }
  }
}

TEST_F(Groups, GroupsOfGroups) {
  const auto tracer = makeEmbreeTracer(scene_);
  const GroupId all = tracer->separate(movable_);
  const std::vector<PrimitiveId> some(movable_.begin(), movable_.begin() + 4);
  const GroupId few = tracer->separate(some);
  EXPECT_NE(all, few);
  expectSameAsFresh(*tracer);
  move(glm::translate(Mat4(1), Vec3(1, 1, 0)));
  tracer->rebuild(all);
  tracer->rebuild(few);
  expectSameAsFresh(*tracer);
}

TEST_F(Groups, RejoinedIsAFreshTracer) {
  const auto tracer = makeEmbreeTracer(scene_);
  tracer->separate(movable_);
  move(glm::translate(Mat4(1), Vec3(1, 1, 0)));
  tracer->rejoin();
  expectSameAsFresh(*tracer);
  EXPECT_EQ(tracer->separate(movable_), GroupId(1));
  expectSameAsFresh(*tracer);
}

TEST_F(Groups, RemovedThingsAreGone) {
  const auto tracer = makeEmbreeTracer(scene_);
  const GroupId group = tracer->separate(movable_);
  for (const PrimitiveId id : movable_) scene_.primitives[id.index()].shape = Sphere{{0, 0, 0}, 0, false};
  tracer->rebuild(group);
  for (const Ray& ray : randomRays(test::randomScene(90, {0, 0, 0}, 2, 1, 7), 5000)) {
    const Hit hit = tracer->closestHit(ray);
    EXPECT_TRUE(!hit || hit.primitive.value % 5 != 0);
    EXPECT_EQ(tracer->transmittance(ray, group), Rgb(1.0f));
  }
}

TEST_F(Groups, TransmittanceOfAGroupAloneAgreesWithBruteForce) {
  for (std::size_t i = 0; i < scene_.primitives.size(); i += 3) scene_.primitives[i].material = MaterialId(1);
  const auto tracer = makeEmbreeTracer(scene_), twin = makeBruteForceTracer(scene_);
  const GroupId group = tracer->separate(movable_);
  ASSERT_EQ(twin->separate(movable_), group);
  int differ = 0;
  for (const Ray& ray : randomRays(scene_, 20000))
    for (const GroupId g : {GroupId(0), group}) {
      const Rgb a = tracer->transmittance(ray, g), b = twin->transmittance(ray, g);
      differ += glm::distance(a, b) > 1e-4f;
    }
  EXPECT_LE(differ, 2) << "edges within rounding";
}

TEST_F(Groups, AWholeSceneMayBeMovable) {
  movable_.clear();
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) movable_.emplace_back(i);
  const auto tracer = makeEmbreeTracer(scene_);
  tracer->rebuild(tracer->separate(movable_));
  expectSameAsFresh(*tracer);
}

}  // namespace
}  // namespace deltalux
