// The transfers between leaves against rays over the hemisphere, which know nothing of links.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/side_locator.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace radiosity;

namespace {

/// A room with a lamp below its ceiling, a block and a ball.
Scene furnished() {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.6f));
  test::addBox(scene, grey, {0, 0, 0}, {4, 3, 2.5}, true);
  test::addBox(scene, grey, {1.5, 1, 0}, {2.2, 1.8, 1.1}, false);
  test::addShape(scene, grey, Sphere{{3, 0.8, 0.5}, 0.4});
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
  test::addPolygon(scene, lamp, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  return scene;
}

/// Irradiance of a leaf from the radiosities of the leaves that cosine-distributed rays from it meet.
double overHemisphere(const Solution& s, const hierarchy::SideLocator& locator, hierarchy::ElementId leaf,
                      std::uint32_t rays) {
  double sum = 0;
  for (std::uint32_t k = 0; k < rays; ++k) {
    const UnitPair u = scrambledSobol(k, 11), v = scrambledSobol(k, 12);
    const hierarchy::PatchPoint p = hierarchy::samplePatch(s.elements, s.scene, leaf, u.x, u.y);
    const double r = std::sqrt(v.x), phi = 2 * kPi * v.y;
    const Vec3f w(Frame(Vec3(p.normal)).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - v.x)}));
    tracing::Ray ray;
    ray.origin = tracing::offsetOrigin(p.position, p.normal, w);
    ray.direction = w;
    const tracing::Hit hit = s.tracer->closestHit(ray);
    if (!hit) continue;
    const hierarchy::ElementId side = locator.side(hit.primitive, hit.triangle, hit.front);
    if (side.valid())
      sum += gray(s.elements.radiometry[locator.locate(side, Vec3(hit.position)).leaf.index()].B) / double(rays);
  }
  return sum;
}

TEST(LeafTransfers, BringWhatRaysOverTheHemisphereFind) {
  Engine engine(furnished());
  engine.solve();
  const Solution& s = engine.solution().get();
  ASSERT_FALSE(s.transfers.empty());
  const hierarchy::SideLocator locator(s.elements, s.scene);
  double power = 0, found = 0, apart = 0;
  int leaves = 0;
  for (std::size_t i = 0; i < s.elements.size(); i += 5) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    if (t.kind != hierarchy::ElementKind::Patch || t.childCount > 0 || t.emitter) continue;
    const double A = s.elements.geometry[i].area, E = gray(s.elements.radiometry[i].indirect);
    const double truth = overHemisphere(s, locator, hierarchy::ElementId(i), 2000);
    power += A * E, found += A * truth, apart += A * std::abs(E - truth);
    ++leaves;
  }
  EXPECT_GT(leaves, 50);
  EXPECT_NEAR(power, found, 0.015 * found);
  EXPECT_LT(apart, 0.06 * found);
}

/// What a row of a leaf brings: irradiance from today's radiosities, without the light that it has too much of.
double broughtBy(const TransferRow& row, const hierarchy::Elements& elements) {
  double sum = 0;
  for (const LeafTransfer& t : row.transfers) sum += gray(t.T * elements.radiometry[t.leaf.index()].B);
  return sum;
}

TEST(LeafTransfers, PartsOfALeafInheritItsRays) {
  constexpr int kRays = 512;
  Engine engine(furnished());
  engine.solve();
  const Solution& s = engine.solution().get();
  hierarchy::Elements elements = s.elements;
  const hierarchy::SideLocator locator(s.elements, s.scene);
  double found = 0, asFresh = 0, light = 0, leaves = 0, cheaper = 0;
  for (const LeafRow& whole : s.transfers.rows()) {
    if (whole.leaf.index() % 5 != 0 || !elements.at(whole.leaf).flat) continue;
    const std::size_t before = elements.size();
    if (!hierarchy::subdivide(elements, s.scene, whole.leaf)) continue;
    const IndirectSampler sampler(s.scene, elements, s.links, *s.tracer);
    std::uint64_t rays = 0;
    const TransferRow from = sampler.atLeaf(whole.leaf, kRays, rays);
    for (std::size_t part = before; part < elements.size(); ++part) {
      std::uint64_t traced = 0, anew = 0;
      const TransferRow row = sampler.inherited(hierarchy::ElementId(part), from, {}, {}, kRays, traced);
      const double A = elements.geometry[part].area;
      found += A * broughtBy(row, elements);
      asFresh += A * broughtBy(sampler.atLeaf(hierarchy::ElementId(part), kRays, anew), elements);
      light += A * overHemisphere(s, locator, whole.leaf, 500);
      cheaper += row.terms.size() == from.terms.size(), ++leaves;
      for (const RowTerm& t : row.terms) ASSERT_TRUE(t.link.index() < s.links.size());
      ASSERT_EQ(row.rays.size(), row.terms.size());
    }
  }
  EXPECT_GT(leaves, 200);
  EXPECT_GT(cheaper, 0.8 * leaves);  // the rays of most do suit their parts
  EXPECT_NEAR(found, asFresh, 0.01 * asFresh);
  EXPECT_NEAR(found, light, 0.02 * light);
}

/// White posts that stand half in a dark floor, so that parts of their sides are covered, and lie behind its plane.
Scene sunkPosts() {
  Scene scene;
  const MaterialId dark = test::addMaterial(scene, "dark", test::lambert(0.02f));
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.8f));
  test::addBox(scene, dark, {0, 0, -1}, {4, 3, 2.5}, true);
  test::addBox(scene, dark, {0, 0, -1}, {4, 3, 0}, false);
  for (int i = 0; i < 12; ++i) {
    const Vec3 at(0.5 + i % 4, 0.5 + i / 4, -0.3);
    test::addBox(scene, white, at, at + Vec3(0.1, 0.1, 0.5), false);
  }
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
  test::addPolygon(scene, lamp, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  return scene;
}

TEST(LeafTransfers, BringWhatSendersSendThatAreCoveredInPart) {
  Engine engine(sunkPosts());
  engine.solve();
  const Solution& s = engine.solution().get();
  const hierarchy::SideLocator locator(s.elements, s.scene);
  double power = 0, found = 0;
  int leaves = 0, covered = 0;
  for (const LeafRow& row : s.transfers.rows()) {
    const hierarchy::ElementGeometry& g = s.elements.shape(row.leaf);
    const bool ofFloor = s.elements.at(row.leaf).flat && g.normal.z > 0.99f && std::abs(g.center.z) < 1e-3f;
    covered += g.exposed < 1.0f && !ofFloor;
    if (!ofFloor || g.exposed < 1.0f) continue;
    power += g.area * broughtBy(row.indirect, s.elements);
    found += g.area * overHemisphere(s, locator, row.leaf, 1000);
    ++leaves;
  }
  EXPECT_GT(leaves, 30);
  EXPECT_GT(covered, 12);
  EXPECT_NEAR(power, found, 0.015 * found);
}

/// White leaves of two sides, each turned some other way, far from the origin, where coordinates are rounded.
Scene foliage() {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.5f));
  for (int i = 0; i < 100; ++i) {
    const Vec3 center(30 + i % 10, -40 + i / 10, 3 + 0.1 * (i % 7));
    const Vec3 u = glm::normalize(Vec3(std::cos(i), std::sin(i), std::cos(3.0 * i)));
    const Vec3 v = glm::normalize(glm::cross(u, Vec3(0.3, std::cos(2.0 * i), 1.0)));
    const double r = 0.2;
    test::addPolygon(scene, white,
                     {center - r * u - r * v, center + r * u - r * v, center + r * u + r * v, center - r * u + r * v});
  }
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
  test::addPolygon(scene, lamp, {{34, -36, 6}, {34, -35, 6}, {35, -35, 6}, {35, -36, 6}});
  return scene;
}

TEST(LeafTransfers, BringNothingFromTheOtherSide) {
  Engine engine(foliage());
  engine.solve();
  const Solution& s = engine.solution().get();
  int transfers = 0;
  for (const LeafRow& row : s.transfers.rows())
    for (const LeafTransfer& t : row.indirect.transfers) {
      ++transfers;
      EXPECT_NE(s.elements.domain[row.leaf.index()].primitive, s.elements.domain[t.leaf.index()].primitive);
    }
  EXPECT_GT(transfers, 1000);
}

TEST(LeafTransfers, AreLinearInEveryLight) {
  Scene scene = furnished();
  Engine engine(scene);
  engine.solve();
  for (Material& m : scene.materials)
    if (m.emission) m.emission->radiance *= 3.0f;
  Engine brighter(scene);
  brighter.solve();
  const auto &a = engine.solution().get().elements.radiometry, &b = brighter.solution().get().elements.radiometry;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(3 * gray(a[i].indirect), gray(b[i].indirect), 1e-3 * gray(b[i].indirect) + 1e-9) << i;
}

}  // namespace
}  // namespace deltalux
