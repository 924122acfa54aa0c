// Fine meshes by lines: leaves lie where light needs them, and light is what it is on other surfaces.
#include <gtest/gtest.h>

#include <deltalux/solution_file.hpp>

#include "base/parallel.hpp"
#include "hierarchy/leaf_table.hpp"
#include "lines/lines.hpp"
#include "scene/light_sampling.hpp"
#include "support/fine_meshes.hpp"
#include "support/solved.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using namespace test;

double hills(double x, double y) { return 0.4 + 0.3 * std::sin(1.5 * x) * std::cos(1.3 * y); }

/// A room of four metres with a lamp; the shape is primitive 0.
Scene room(Shape shape, Surface surface) {
  Scene scene;
  addShape(scene, addMaterial(scene, "shape", std::move(surface)), std::move(shape));
  addBox(scene, addMaterial(scene, "wall", lambert(0.7f)), Vec3(0), {4, 4, 2.5}, true);
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0.0f), Emission{Rgb(20.0f), false, {}}),
             {{1.5, 2.5, 2.4}, {2.5, 2.5, 2.4}, {2.5, 1.5, 2.4}, {1.5, 1.5, 2.4}});
  return scene;
}

std::size_t leavesOf(const Engine& engine) { return hierarchy::LeafTable(engine.solution().get().elements).size(); }

TEST(FineMesh, LeavesAndLightAreThoseOfTheShapeNotOfItsFaces) {
  const Engine coarse = solved(room(ground(4, 24, hills), lambert(0.4f)), 0.05),
               fine = solved(room(ground(4, 200, hills), lambert(0.4f)), 0.05);
  EXPECT_NEAR(double(leavesOf(fine)) / double(leavesOf(coarse)), 1, 0.25);
  EXPECT_LT(leavesOf(fine), 8000u);
  for (const std::size_t i : {0, 2, 3, 4, 5, 6})  // the floor below lies in the dark
    EXPECT_NEAR(meshMean(fine, PrimitiveId(i)) / meshMean(coarse, PrimitiveId(i)), 1, 0.03) << i;
}

TEST(FineMesh, AFlatOneIsAsAPolygon) {
  const Engine mesh = solved(room(ground(4, 60, [](double, double) { return 0.5; }), lambert(0.4f)), 0.05);
  Scene scene = room(ground(4, 2, [](double, double) { return 0.5; }), lambert(0.4f));
  const Engine plain = solved(std::move(scene), 0.05);
  for (const std::size_t i : {0, 2, 3, 4, 5, 6})
    EXPECT_NEAR(meshMean(mesh, PrimitiveId(i)) / meshMean(plain, PrimitiveId(i)), 1, 0.02) << i;
  EXPECT_EQ(meshMean(mesh, PrimitiveId(1)), 0);  // no light leaks to the floor below
}

TEST(FineMesh, AFurnaceIsEvenOverIt) {
  Scene scene;
  addShape(scene, addMaterial(scene, "ball", lambert(0.5f)), ball({0.5, 0.5, 0.5}, 0.3, 40));
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f), Emission{Rgb(1.0f), false, {}}), Vec3(0), Vec3(1), true);
  // The ball sends only what it reflects: its light is that of the walls less what it keeps from them.
  const Engine engine = solved(std::move(scene), 0.05);
  const hierarchy::Elements& e = engine.solution().get().elements;
  double lowest = kInfinity, highest = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (!e.isReceivingLeaf(hierarchy::ElementId(i)) || e.domain[i].primitive != PrimitiveId(0) || !e.topology[i].front)
      continue;
    const double E = gray(e.radiometry[i].direct + e.radiometry[i].indirect);
    lowest = std::min(lowest, E), highest = std::max(highest, E);
  }
  EXPECT_GT(lowest, 1.5 * kPi);
  EXPECT_LT(highest / lowest, 1.15);
}

TEST(FineMesh, LightComesThroughASheetOfIt) {
  Trans sheet;
  sheet.diffuseReflectance = Rgb(0.2f), sheet.diffuseTransmittance = Rgb(0.5f);
  const auto flat = [](double, double) { return 1.2; };
  const Engine fine = solved(room(ground(4, 40, flat), sheet), 0.05),
               plain = solved(room(ground(4, 1, flat), sheet), 0.05);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_NEAR(meshMean(fine, PrimitiveId(i)) / meshMean(plain, PrimitiveId(i)), 1, 0.02) << i;
}

TEST(FineMesh, CausticsFallOnIt) {
  const auto scene = [](std::uint32_t n) {
    Scene s = room(ground(4, n, [](double, double) { return 0.01; }), lambert(0.4f));
    addShape(s, addMaterial(s, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{2, 2, 1}, 0.4});
    return s;
  };
  const auto particlesOn = [](const Engine& engine) {
    const hierarchy::Elements& e = engine.solution().get().elements;
    double sum = 0;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e.isReceivingLeaf(hierarchy::ElementId(i)) && e.domain[i].primitive == PrimitiveId(0))
        sum += e.geometry[i].area * gray(e.radiometry[i].particle);
    return sum;
  };
  const Engine fine = solved(scene(60), 0.05), plain = solved(scene(1), 0.05);
  EXPECT_GT(particlesOn(plain), 0.5);
  EXPECT_NEAR(particlesOn(fine) / particlesOn(plain), 1, 0.01);
}

TEST(FineMesh, ANarrowSpotIsFoundWhereverItFalls) {
  for (const Vec2 at : {Vec2(0.31, 3.7), Vec2(2.02, 1.33)}) {
    Scene scene;
    addShape(scene, addMaterial(scene, "ground", lambert(0.5f)), ground(4, 224, hills));
    addBox(scene, addMaterial(scene, "wall", lambert(0.5f)), Vec3(0), {4, 4, 2.5}, true);
    SpotLight spot;
    spot.position = Vec3(at, 2.4), spot.direction = {0, 0, -1}, spot.intensity = Rgb(100.0f);
    spot.cosInner = std::cos(0.015), spot.cosOuter = std::cos(0.016);
    addLight(scene, spot);
    double power = 0;
    constexpr int kSteps = 1000;
    const scene::LightSampler lights(scene);
    for (int k = 0; k < kSteps; ++k) {
      const double theta = 0.016 * (k + 0.5) / kSteps;
      power += 0.016 / kSteps * 2 * kPi * std::sin(theta) *
               gray(lights.intensity(LightId(0), {std::sin(theta), 0, -std::cos(theta)}));
    }
    const Engine engine = solved(std::move(scene), 0.05);
    const hierarchy::Elements& e = engine.solution().get().elements;
    double direct = 0;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e.isReceivingLeaf(hierarchy::ElementId(i))) direct += e.geometry[i].area * gray(e.radiometry[i].direct);
    EXPECT_NEAR(direct / power, 1, 0.1);
  }
}

TEST(FineMesh, IsTheSameByAnyNumberOfThreadsAndFromAFile) {
  std::vector<std::uint64_t> hashes;
  for (const std::size_t threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const Engine engine = solved(room(ball({2, 2, 1}, 0.6, 30), lambert(0.4f)), 0.1);
    hashes.push_back(hashOf(engine));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);

  const Engine engine = solved(room(ball({2, 2, 1}, 0.6, 30), lambert(0.4f)), 0.1);
  const TempFolder folder;
  saveSolution(folder.path() / "s.dlx", engine.solution());
  const SolutionView loaded = loadSolution(folder.path() / "s.dlx");
  const hierarchy::Elements &a = engine.solution().get().elements, &b = loaded.get().elements;
  ASSERT_EQ(a.size(), b.size());
  for (std::uint32_t t = 0; t < 30 * 29 * 4; ++t)
    EXPECT_EQ(a.sides.at({PrimitiveId(0), t, true}), b.sides.at({PrimitiveId(0), t, true}));
}

}  // namespace
}  // namespace deltalux
