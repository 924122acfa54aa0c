// What a segment meets, a ray tracer and points along it agree on; what stays clear of everything is let go.
#include "particles/moved_shapes.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "tracing/ray_tracer.hpp"
#include "tracing/test_scenes.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr double kMargin = 1e-4;

std::vector<Shape> someShapes() {
  std::vector<Shape> shapes;
  shapes.push_back(Sphere{Vec3(0.1, 0.2, 0.3), 0.4});
  shapes.push_back(Cylinder{Vec3(-0.5, 0.1, -0.2), Vec3(0.3, 0.4, 0.5), 0.25});
  shapes.push_back(Cone{Vec3(0, 0, -0.4), Vec3(0.1, 0.2, 0.5), 0.5, 0.1});
  shapes.push_back(Ring{Vec3(0.1, -0.1, 0), glm::normalize(Vec3(1, 2, 3)), 0.2, 0.6});
  shapes.push_back(*makePolygon({Vec3(-0.5, -0.5, 0), Vec3(0.6, -0.4, 0), Vec3(0.1, 0, 0), Vec3(0.4, 0.6, 0)}));
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Rng rng(5, 1);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3 at(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    for (int k = 0; k < 3; ++k) corners.push_back(at + 0.1 * Vec3(rng.uniform(), rng.uniform(), rng.uniform()));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  shapes.push_back(*makeMesh(corners, triangles));
  return shapes;
}

/// Whether the tracer meets the shape between a and b.
bool hit(const tracing::RayTracer& tracer, const Vec3f& a, const Vec3f& b) {
  tracing::Ray ray;
  ray.origin = a, ray.tFar = glm::length(b - a);
  ray.direction = (b - a) / ray.tFar;
  return static_cast<bool>(tracer.closestHit(ray));
}

/// Of 4,000 segments: none that is hit may be missed, and few may be met that are not hit.
TEST(MovedShapes, AgreeWithTheTracer) {
  for (const Shape& shape : someShapes()) {
    Scene scene = test::emptyScene();
    test::add(scene, shape);
    const auto tracer = tracing::makeBruteForceTracer(scene);
    const Shape* const only = &shape;
    const MovedShapes shapes(std::span(&only, 1), kMargin);
    Rng rng(7, shape.index());
    const auto number = [&] { return static_cast<float>(2 * rng.uniform() - 1); };
    int met = 0, hits = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3f a(number(), number(), number()), b(number(), number(), number());
      const bool meets = shapes.meets(a, b), is = hit(*tracer, a, b);
      EXPECT_TRUE(meets || !is) << "shape " << shape.index() << ", segment " << i;
      met += meets, hits += is;
    }
    EXPECT_GT(hits, 50) << "shape " << shape.index();
    EXPECT_LT(met - hits, 0.02 * hits + 10) << "shape " << shape.index();
  }
}

/// A segment that ends on a surface, and one that lies in it, meet it.
TEST(MovedShapes, TouchingCounts) {
  const Shape square = *makePolygon({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)});
  const Shape* const only = &square;
  const MovedShapes shapes(std::span(&only, 1), kMargin);
  EXPECT_TRUE(shapes.meets(Vec3f(0.5f, 0.5f, 1), Vec3f(0.5f, 0.4f, 0)));
  EXPECT_TRUE(shapes.meets(Vec3f(-1, 0.5f, 0), Vec3f(2, 0.5f, 0)));
  EXPECT_FALSE(shapes.meets(Vec3f(0.5f, 0.5f, 1), Vec3f(0.5f, 0.4f, 0.01f)));
  EXPECT_FALSE(shapes.meets(Vec3f(1.5f, 0.5f, 1), Vec3f(1.5f, 0.5f, -1)));
}

TEST(MovedShapes, NothingMeetsWhatIsNotThere) {
  const MovedShapes none({}, kMargin);
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(none.meets(Vec3f(-1), Vec3f(1)));
}

}  // namespace
}  // namespace deltalux
