// Surfaces that are covered in part: light passes the rest straight on, as much at every angle, and what covers
// reflects as it does. Solver, reference integrator and closed forms agree, and the energy ledger closes.
#include <gtest/gtest.h>

#include <deltalux/reference.hpp>

#include "support/residue.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr float kSun = 1e5f, kSunRadius = 0.004654793f;

MaterialId addSheet(Scene& scene, Surface surface, float coverage, const Rgb& filter = Rgb(1.0f)) {
  const MaterialId id = addMaterial(scene, "sheet", std::move(surface));
  scene.materials[id.index()].coverage = coverage, scene.materials[id.index()].filter = filter;
  return id;
}

void addSquare(Scene& scene, MaterialId material, double half, double z) {
  addPolygon(scene, material, {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
}

std::vector<ProbeResult> byReference(const Scene& scene, const std::vector<ProbePoint>& points, std::uint64_t samples) {
  ReferenceSettings settings;
  settings.samples = samples;
  return ReferenceIntegrator(scene, settings).probe(points);
}

TEST(Coverage, PassesTheSunAlikeAtEveryAngle) {
  for (const double degrees : {0.0, 60.0, 80.0}) {
    const double t = glm::radians(degrees);
    const SunLight sun{{std::sin(t), 0, std::cos(t)}, kSunRadius, Rgb(kSun)};
    Scene scene;
    addSquare(scene, addMaterial(scene, "floor", lambert(0)), 1, 0);
    addSquare(scene, addSheet(scene, lambert(0), 0.75f, Rgb(1.0f, 0.5f, 0.0f)), 50, 0.5);
    addLight(scene, sun);
    const double whole = kSun * solidAngle(sun) * std::cos(t);
    const std::vector<ProbePoint> floor{{{0.1, 0.2, 0}, {0, 0, 1}}};
    const Engine engine = solved(scene);
    const ProbeResult probed = measure(engine, floor)[0], traced = byReference(scene, floor, 64)[0];
    for (const ProbeResult& r : {probed, traced}) {
      EXPECT_NEAR(r.irradiance.r / whole, 0.25, 0.0025) << degrees;
      EXPECT_NEAR(r.irradiance.g / whole, 0.125, 0.00125) << degrees;
      EXPECT_EQ(r.irradiance.b, 0) << degrees;
    }
    const double direct = whole * gray(glm::dvec3(0.25, 0.125, 0.0));
    EXPECT_NEAR(meshMean(engine, PrimitiveId(0)) / direct, 1, 0.01) << degrees;
  }
}

TEST(Coverage, ThrowsBackWhatItsCoveredPartReflects) {
  const SunLight sun{{0, 0, 1}, kSunRadius, Rgb(kSun)};
  Scene scene;
  addSquare(scene, addMaterial(scene, "floor", lambert(0)), 10, 0);
  addSquare(scene, addSheet(scene, lambert(1), 0.5f), 2, 2);
  addLight(scene, sun);
  const double whole = kSun * solidAngle(sun);
  // On the floor; close above the sheet, looking down on it; on its two sides.
  const std::vector<ProbePoint> points{
      {{0, 0, 0}, {0, 0, 1}}, {{0, 0, 2.05}, {0, 0, -1}}, {{0.3, 0, 2}, {0, 0, 1}}, {{0.3, 0, 2}, {0, 0, -1}}};
  const double expected[] = {0.5, 0.5, 1, 0};
  const auto probed = measure(solved(scene), points), traced = byReference(scene, points, 4096);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(probed[i].irradiance.g / whole, expected[i], 0.01) << i;
    if (i < 3) {
      EXPECT_NEAR(traced[i].irradiance.g / whole, expected[i], 0.01) << i;
    }
  }
}

/// A white sheet takes nothing from a furnace: whatever its coverage, light is the same everywhere and from all around.
TEST(Coverage, FurnaceStaysOneWithAHalfCoveringSheet) {
  constexpr float kRho = 0.5f;
  for (const Surface& surface : {Surface(lambert(1)), Surface(Opaque{Rgb(0.4f), {}, {Rgb(0.6f), 0.1f}}),
                                 Surface(Trans{Rgb(0.5f), Rgb(0.5f), {}, {}})}) {
    Scene scene;
    addBox(scene, addMaterial(scene, "wall", lambert(kRho), Emission{Rgb(1.0f), false, {}}), {-1, -1, -1},
           {1, 1.5, 0.8}, true);
    addSquare(scene, addSheet(scene, surface, 0.5f), 0.7, -0.2);
    const double whole = kPi / (1 - kRho);
    SolveSettings settings;
    settings.error = 0.02, settings.particles = 300000;
    Engine engine(std::move(scene), settings);
    const EnergyLedger ledger = engine.solve().energy;
    EXPECT_NEAR(residue(ledger), 0, 0.005);
    EXPECT_EQ(*ledger.escapedW, 0);
    for (const ProbeResult& r : measure(engine, {{{0.1, 0.2, -1}, {0, 0, 1}},
                                                 {{0.1, 0.2, 0.8}, {0, 0, -1}},
                                                 {{0.1, 0.2, -0.2}, {0, 0, 1}},
                                                 {{0.1, 0.2, -0.2}, {0, 0, -1}},
                                                 {{0.1, 0.2, 0.1}, {0, 0, -1}}}))
      EXPECT_NEAR(r.irradiance.g / whole, 1, 0.02) << surface.index();
  }
}

/// A room with a lamp above a glossy coloured sheet, and a bare one before a mirror.
Scene roomWithSheets() {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.6f)), {-1, -1, 0}, {1, 1, 2}, true);
  addSquare(scene, addSheet(scene, Opaque{Rgb(0.6f, 0.3f, 0.2f), {}, {Rgb(0.3f), 0.15f}}, 0.6f, Rgb(1.0f, 0.8f, 0.6f)),
            0.6, 1);
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
             {{0.95, -0.5, 0.3}, {0.95, -0.5, 1.3}, {0.95, 0.5, 1.3}, {0.95, 0.5, 0.3}});  // faces -x
  addPolygon(scene, addSheet(scene, lambert(0.2f), 0.5f),
             {{0.7, -0.6, 0.1}, {0.7, 0.6, 0.1}, {0.7, 0.6, 1.5}, {0.7, -0.6, 1.5}});
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(20.0f), false, {}}),
             {{-0.2, -0.2, 1.95}, {-0.2, 0.2, 1.95}, {0.2, 0.2, 1.95}, {0.2, -0.2, 1.95}});
  return scene;
}

TEST(Coverage, SolverAgreesWithTheReference) {
  const Scene scene = roomWithSheets();
  std::vector<ProbePoint> points{
      {{0, 0, 0}, {0, 0, 1}},      {{0.4, 0.3, 0}, {0, 0, 1}},    {{-0.9, 0.1, 0}, {0, 0, 1}},
      {{0.1, 0.1, 1}, {0, 0, 1}},  {{0.1, 0.1, 1}, {0, 0, -1}},   {{-1, 0.1, 0.6}, {1, 0, 0}},
      {{-1, 0, 1.4}, {1, 0, 0}},   {{0.7, 0, 0.7}, {1, 0, 0}},    {{0.7, 0, 0.7}, {-1, 0, 0}},
      {{0.3, 0.5, 2}, {0, 0, -1}}, {{0.2, 0, 0.5}, {1, 0, 0}},    {{0.2, 0, 0.5}, {0, 0, 1}},
      {{0.85, 0, 0.8}, {1, 0, 0}}, {{-0.3, 0.2, 1.5}, {0, 0, -1}}};
  SolveSettings settings;
  settings.error = 0.02, settings.particles = 500000;
  Engine engine(scene, settings);
  const EnergyLedger ledger = engine.solve().energy;
  EXPECT_NEAR(residue(ledger), 0, 0.01);
  const auto probed = measure(engine, points), traced = byReference(scene, points, 1 << 16);
  // Leaves' rays and particles leave some per cent of noise at a point, of which the mean over all knows little.
  std::vector<double> differences;
  double mean = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double ratio = probed[i].irradiance[c] / traced[i].irradiance[c];
      differences.push_back(std::abs(ratio - 1)), mean += ratio / (3.0 * static_cast<double>(points.size()));
      EXPECT_LT(differences.back(), 0.1) << i << " channel " << c << ": " << probed[i].irradiance[c] << " for "
                                         << traced[i].irradiance[c];
    }
  EXPECT_LT(spreadOf(differences).median, 0.015);
  EXPECT_NEAR(mean, 1, 0.015);
}

TEST(Coverage, IsSeenThroughInPictures) {
  Scene scene;
  addSquare(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(4.0f), false, {}}), 3, 0);
  addSquare(scene, addSheet(scene, lambert(0), 0.25f, Rgb(1.0f, 0.5f, 1.0f)), 3, 1);
  addAreaLights(scene);
  View view{"down", View::Kind::Parallel, {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 1, 1};
  RenderSettings settings;
  settings.width = settings.height = 4;
  ReferenceSettings reference;
  reference.samples = 64;
  const Image traced = ReferenceIntegrator(scene, reference).render(view, 4, 4);
  const Image rendered = render(solved(scene, 0.1).solution(), view, settings);
  for (const Image& image : {traced, rendered}) {
    Rgb mean(0.0f);
    for (const Rgb& p : image.pixels) mean += p / 16.0f;
    EXPECT_NEAR(mean.r, 3, 0.1);
    EXPECT_NEAR(mean.g, 1.5, 0.05);
  }
  for (const Rgb& p : rendered.pixels) EXPECT_FLOAT_EQ(p.r, 3) << "without a grain";
}

/// What covers nothing is not there.
TEST(Coverage, NothingIsThere) {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f)), Vec3(-1), Vec3(1), true);
  addLight(scene, PointLight{{0, 0, 0.6}, Rgb(1.0f)});
  const std::vector<ProbePoint> points{{{0, 0, -1}, {0, 0, 1}}, {{0, 1, 0}, {0, -1, 0}}, {{0, 0, 0}, {0, 0, 1}}};
  const auto without = measure(solved(scene), points);
  addSquare(scene, addSheet(scene, Opaque{Rgb(0.3f), {}, {Rgb(0.5f), 0.1f}}, 0), 0.9, 0);
  const Engine engine = solved(scene);
  EXPECT_TRUE(visiblePoints(scene, {"down", View::Kind::Parallel, {0, 0, 0.5}, {0, 0, -1}, {0, 1, 0}, 0.1, 0.1}, 1, 1)
                  .at(0)
                  ->position.z < -0.9);
  const auto with = measure(engine, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(with[i].irradiance.g / without[i].irradiance.g, 1, 0.01) << i;
}

}  // namespace
}  // namespace deltalux
