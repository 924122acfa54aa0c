#include <gtest/gtest.h>

#include "base/random.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
using namespace tracing;

namespace {

TEST(Segment, IsNotBlockedByTheSurfacesItJoins) {
  // A unit square with a corner at the origin, where coordinates and so their rounding vanish, seen from far and near.
  Scene scene;
  scene.materials.push_back({"m", Opaque{}, std::nullopt});
  scene.objects.push_back({"square", {}});
  for (const double height : {0.01, 1.0, 30.0}) {
    const auto square = makePolygon({{0, 0, height}, {0, 1, height}, {1, 1, height}, {1, 0, height}});
    scene.primitives = {{*makePolygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), MaterialId(0), ObjectId(0)},
                        {*square, MaterialId(0), ObjectId(0)}};
    const auto embree = makeEmbreeTracer(scene), brute = makeBruteForceTracer(scene);
    Rng rng(5);
    for (int i = 0; i < 20000; ++i) {
      const double near = std::pow(10.0, -6.0 * rng.uniform());  // many points close to the corner
      const SurfacePoint a = pointAt(scene.primitives[0].shape, {near * rng.uniform(), near * rng.uniform()});
      const SurfacePoint b = pointAt(scene.primitives[1].shape, {rng.uniform(), rng.uniform()});
      for (const Ray& ray : {segment(Vec3f(a.position), Vec3f(a.normal), Vec3f(b.position), Vec3f(b.normal)),
                             segment(Vec3f(b.position), Vec3f(b.normal), Vec3f(a.position), Vec3f(a.normal))}) {
        ASSERT_FALSE(embree->occluded(ray)) << height << " " << i;
        ASSERT_FALSE(brute->occluded(ray)) << height << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace deltalux
