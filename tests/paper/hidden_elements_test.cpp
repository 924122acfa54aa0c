#include "paper/hidden_elements.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "support/rooms.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
using namespace paper;

namespace {

Vec3 pointIn(Rng& rng, const Vec3& lower, const Vec3& upper) {
  return lower + Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * (upper - lower);
}

/// Screens at all angles around a box: triangles, squares and others with a notch, and little blocks all over the
/// place.
Scene screens(std::uint64_t seed) {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  Rng rng(seed);
  for (int k = 0; k < 24; ++k) {
    const Vec3 u = glm::normalize(pointIn(rng, Vec3(-1), Vec3(1))), n = glm::normalize(pointIn(rng, Vec3(-1), Vec3(1)));
    const Vec3 v = glm::normalize(glm::cross(n, u)), at = 2.0 * n + 0.3 * u;
    const double a = 0.5 + 1.5 * rng.uniform(), b = 0.5 + 1.5 * rng.uniform();
    std::vector<Vec3> corners{at - a * u - b * v, at + a * u - b * v, at + a * u + b * v};
    if (k % 3 != 0) corners.push_back(at - a * u + b * v);
    if (k % 3 == 2) corners.push_back(at - 0.5 * a * u);  // the notch
    test::addPolygon(scene, grey, corners);
  }
  for (int k = 0; k < 200; ++k) {
    const Vec3 lower = pointIn(rng, Vec3(-8), Vec3(8));
    if (glm::length(lower) < 3) continue;
    test::addBox(scene, grey, lower, lower + pointIn(rng, Vec3(0.02), Vec3(0.5)), false);
  }
  return scene;
}

bool pass(const tracing::RayTracer& tracer, const Vec3f& from, const Vec3f& to) {
  tracing::Ray ray;
  ray.origin = from, ray.direction = to - from, ray.tNear = 0, ray.tFar = 1;
  return !tracer.occluded(ray);
}

// From no point of a hidden element a line to the region passes the one that is said to hide it, and many are hidden.
TEST(HiddenElements, LieBehindTheirOccluders) {
  const Box region{Vec3(-0.3, -0.2, -0.25), Vec3(0.25, 0.3, 0.2)};
  std::size_t hidden = 0, patches = 0, seen = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = screens(seed);
    const hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    const auto tracer = tracing::makeEmbreeTracer(scene);
    Rng rng(seed);
    std::vector<char> isHidden(elements.size(), 0);
    for (const HiddenElement& h : hiddenElements(elements, scene, region)) {
      Scene alone;
      alone.materials = scene.materials;
      const Primitive& p = scene[elements.domain[h.occluder.index()].primitive];
      alone.primitives.push_back({p.shape, p.material, {}});
      const auto occluder = tracing::makeEmbreeTracer(alone);
      const Box box = elements.box(h.element);
      for (int k = 0; k < 32; ++k)
        EXPECT_FALSE(pass(*occluder, Vec3f(pointIn(rng, box.lower, box.upper)),
                          Vec3f(pointIn(rng, region.lower, region.upper))));
      hierarchy::forEachBelow(elements, h.element, [&](hierarchy::ElementId e) { return isHidden[e.index()] = 1; });
    }
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!elements.isPatch(hierarchy::ElementId(i))) continue;
      ++patches, hidden += isHidden[i];
      const hierarchy::PatchPoint p =
          hierarchy::samplePatch(elements, scene, hierarchy::ElementId(i), rng.uniform(), rng.uniform());
      const bool sees = pass(*tracer, p.position + 1e-3f * p.normal, Vec3f(pointIn(rng, region.lower, region.upper)));
      EXPECT_FALSE(sees && isHidden[i]);
      seen += sees;
    }
  }
  EXPECT_GT(hidden, patches / 5);
  EXPECT_GT(seen, 100u);
}

TEST(HiddenElements, AreNoneBehindGlassOrWhatLiesInTheRegion) {
  for (const bool glass : {true, false}) {
    Scene scene;
    const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
    const MaterialId pane = test::addMaterial(scene, "pane", ThinGlass{});
    test::addPolygon(scene, glass ? pane : grey, {{1, -3, -3}, {1, 3, -3}, {1, 3, 3}, {1, -3, 3}});
    test::addBox(scene, grey, {2, -0.5, -0.5}, {3, 0.5, 0.5}, false);
    const hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    const Box beside{Vec3(-0.5), Vec3(0.5)}, across{Vec3(-0.5), Vec3(1.5, 0.5, 0.5)};
    EXPECT_EQ(hiddenElements(elements, scene, beside).empty(), glass);
    for (const HiddenElement& h : hiddenElements(elements, scene, across))
      EXPECT_NE(elements.domain[h.occluder.index()].primitive, PrimitiveId(0u));
  }
}

}  // namespace
}  // namespace deltalux
