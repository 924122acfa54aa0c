// Solves over stored lines: known answers, conservation, and that they are functions of the scene alone.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.hpp"
#include "engine/line_solve.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "lines/lines.hpp"
#include "support/furnished_room.hpp"
#include "support/plates.hpp"
#include "support/reference_values.hpp"
#include "support/residue.hpp"
#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

TEST(LineSolve, AFurnaceIsExactOnTheMesh) {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f), Emission{Rgb(1.0f), false, {}}), Vec3(0), Vec3(1), true);
  const Engine engine = solved(std::move(scene), 0.05);
  const SolutionView view = engine.solution();
  const hierarchy::Elements& e = view.get().elements;
  int leaves = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (!e.isReceivingLeaf(hierarchy::ElementId(i)) || !e.topology[i].front) continue;
    // Emitted light arrives by shadow rays, the rest is reflected: E = pi / (1 - rho).
    EXPECT_NEAR(gray(e.radiometry[i].indirect), 0.5 / (1 - 0.5) * kPi, 0.06 * kPi);
    ++leaves;
  }
  EXPECT_GT(leaves, 5);
  const double indirect = meshMean(engine, PrimitiveId(0));
  EXPECT_NEAR(indirect, 2 * kPi, 0.01 * 2 * kPi);
}

TEST(LineSolve, PlatesHaveTheirClosedForms) {
  for (const Plates& p : kPlates)
    EXPECT_NEAR(factorOf(p, [](Scene s) { return solved(std::move(s), 0.01); }) / p.factor, 1, 0.01) << p.name;
}

TEST(LineSolve, AFieldUnderTheSkyGetsItWholeByFewLinesToo) {
  for (const double error : {0.2, 0.1, 0.05}) {
    Scene scene;
    addPolygon(scene, addMaterial(scene, "grass", lambert(0.2f)), {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}});
    addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(1.0f), UniformSky{1.0}, {0, 0, 1}});
    const Engine engine = solved(std::move(scene), error);
    EXPECT_NEAR(meshMean(engine, PrimitiveId(0)), kPi, 0.5 * error * kPi) << error;
  }
}

TEST(LineSolve, EnergyIsKeptToAThousandth) {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f)), {0, 0, 0}, {1, 1.5, 0.8}, true);
  addBox(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.8f)}), {0.2, 0.3, 0.1}, {0.5, 0.6, 0.5}, false);
  addBox(scene, addMaterial(scene, "gloss", Opaque{Rgb(0.3f), {}, {Rgb(0.4f), 0.1f, SpecularLobe::Distribution::Ggx}}),
         {0.7, 0.2, 0}, {0.9, 0.4, 0.5}, false);
  addShape(scene, addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{0.6, 1.1, 0.3}, 0.2});
  addLight(scene, PointLight{{0.7, 0.7, 0.6}, Rgb(1.0f)});
  const Engine engine = solved(std::move(scene), 0.02);
  const EnergyLedger l = engine.solution().report().energy;
  EXPECT_NEAR(*l.emittedW, 4 * kPi, 0.005 * 4 * kPi);
  EXPECT_NEAR(*l.escapedW, 0, 1e-6 * 4 * kPi);
  EXPECT_NEAR(residue(l), 0, 0.002);
}

TEST(LineSolve, GlossyRoomsKeepTheirLight) {
  // Every line may end or go on: what a few find by chance is no reason to cut rows off.
  Scene scene;
  const SpecularLobe gloss{Rgb(0.35f), 0.15f, SpecularLobe::Distribution::Ggx};
  addBox(scene, addMaterial(scene, "wall", Opaque{Rgb(0.4f), {}, gloss}), {0, 0, 0}, {3, 4, 2.5}, true);
  addBox(scene, addMaterial(scene, "block", Opaque{Rgb(0.3f), {}, gloss}), {1, 1, 0}, {1.5, 1.6, 0.7}, false);
  addLight(scene, PointLight{{1.5, 2.5, 2}, Rgb(1.0f)});
  const Engine engine = solved(std::move(scene), 0.05);
  const EnergyLedger l = engine.solution().report().energy;
  EXPECT_NEAR(residue(l), 0, 0.005);
}

/// A room with a block and a ball, about the z axis turned by `angle`, and two lamps.
Scene turnedRoom(double angle, float first, float second) {
  const glm::dmat3 turn(glm::rotate(Mat4(1.0), angle, Vec3(0, 0, 1)));
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.7f));
  const auto turned = [&](std::vector<Vec3> vertices) {
    for (Vec3& v : vertices) v = turn * v;
    return vertices;
  };
  const auto box = [&](MaterialId m, const Vec3& a, const Vec3& b, bool inward) {
    Scene straight;
    addBox(straight, addMaterial(straight, "m", lambert(0)), a, b, inward);
    for (const Primitive& p : straight.primitives) addPolygon(scene, m, turned(std::get<Polygon>(p.shape).vertices));
  };
  box(white, Vec3(0), {3, 2.5, 2.2}, true);
  box(addMaterial(scene, "red", Opaque{Rgb(0.6f, 0.2f, 0.1f), {}, {}}), {0.8, 0.7, 0}, {1.4, 1.5, 0.9}, false);
  addShape(scene, white, Sphere{turn * Vec3(2.2, 1.2, 0.5), 0.3, false});
  addLight(scene, PointLight{turn * Vec3(0.5, 1.2, 2), Rgb(first)});
  addLight(scene, PointLight{turn * Vec3(2.4, 1.6, 1.9), Rgb(second)});
  return scene;
}

std::vector<double> luxAt(Scene scene, double angle) {
  const glm::dmat3 turn(glm::rotate(Mat4(1.0), angle, Vec3(0, 0, 1)));
  std::vector<ProbePoint> points;
  for (const double x : {0.3, 1.1, 1.9, 2.7})
    for (const double y : {0.3, 1.8, 2.3}) {
      points.push_back({turn * Vec3(x, y, 0), {0, 0, 1}});
      points.push_back({turn * Vec3(x, y, 2.2), {0, 0, -1}});
      points.push_back({turn * Vec3(x, 0, 0.4 * y), turn * Vec3(0, 1, 0)});
    }
  std::vector<double> values;
  for (const ProbeResult& r : measure(solved(std::move(scene), 0.05), points)) values.push_back(lux(r));
  return values;
}

TEST(LineSolve, IsLinearInTheLamps) {
  const auto first = luxAt(turnedRoom(0, 12, 0), 0), second = luxAt(turnedRoom(0, 0, 5), 0),
             both = luxAt(turnedRoom(0, 12, 5), 0);
  std::vector<double> differences;
  for (std::size_t i = 0; i < both.size(); ++i) differences.push_back(std::abs((first[i] + second[i]) / both[i] - 1));
  EXPECT_LT(spreadOf(differences).median, 0.01);
  EXPECT_LT(spreadOf(differences).p95, 0.04);
}

TEST(LineSolve, IsTheSameInATurnedScene) {
  const auto straight = luxAt(turnedRoom(0, 12, 5), 0), turned = luxAt(turnedRoom(0.6, 12, 5), 0.6);
  std::vector<double> differences;
  for (std::size_t i = 0; i < straight.size(); ++i) differences.push_back(std::abs(turned[i] / straight[i] - 1));
  EXPECT_LT(spreadOf(differences).median, 0.01);
  EXPECT_LT(spreadOf(differences).p95, 0.04);
}

TEST(LineSolve, OneHashForAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  for (const std::size_t threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    hashes.push_back(hashOf(solved(furnishedRoom(), 0.1)));
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
}

TEST(LineSolve, AnUpdatedSolutionIsTheFreshOne) {
  Engine edited = solved(furnishedRoom(), 0.1);
  const auto editable = editableOfFurnishedRoom();
  edited.apply(TransformObject{editable.objects.front(), glm::translate(Mat4(1.0), Vec3(0.1, 0.05, 0))});
  edited.update();
  Engine fresh = solved(edited.solution().scene(), 0.1);
  EXPECT_EQ(hashOf(edited), hashOf(fresh));
}

TEST(LineSolve, LightThatComesThroughASheetAloneIsThere) {
  // A long room, parted by a sheet that passes half of the light diffusely; the lamp is on one side.
  Scene scene;
  addBox(scene, addMaterial(scene, "white", lambert(0.6f)), {0, 0, 0}, {4, 2, 2}, true);
  Trans sheet;
  sheet.diffuseReflectance = Rgb(0.2f), sheet.diffuseTransmittance = Rgb(0.5f);
  addPolygon(scene, addMaterial(scene, "sheet", sheet), {{2, 0, 0}, {2, 2, 0}, {2, 2, 2}, {2, 0, 2}});
  addLight(scene, PointLight{{1, 1, 1.5}, Rgb(10.0f)});
  const std::vector<ProbePoint> points{{{3, 1, 0}, {0, 0, 1}}, {{4, 1, 1}, {-1, 0, 0}}};
  ReferenceSettings settings;
  settings.samples = 1 << 14;
  const std::vector<ProbeResult> expected = ReferenceIntegrator(scene, settings).probe(points);
  const auto measured = measure(solved(std::move(scene), 0.05), points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(lux(measured[i]) / lux(expected[i]), 1, 0.04) << i;
}

TEST(LineSolve, WallsKeepLightOnTheirSide) {
  // A sheet parts the box; floor, ceiling and walls are polygons of both rooms.
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.7f));
  addBox(scene, white, Vec3(0), {4, 2, 2}, true);
  addPolygon(scene, white, {{2.3, 0, 0}, {2.3, 2, 0}, {2.3, 2, 2}, {2.3, 0, 2}});
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0), Emission{Rgb(20.0f), false, {}});
  addPolygon(scene, lamp, {{0.4, 0.4, 1.98}, {0.4, 1.6, 1.98}, {1.4, 1.6, 1.98}, {1.4, 0.4, 1.98}});
  const Engine engine = solved(std::move(scene), 0.05);
  const auto E = measure(
      engine, {{{1, 1, 0}, {0, 0, 1}}, {{3, 1, 0}, {0, 0, 1}}, {{3, 1, 2}, {0, 0, -1}}, {{4, 1, 1}, {-1, 0, 0}}});
  EXPECT_GT(E[0].irradiance.g, 1);
  for (std::size_t i = 1; i < E.size(); ++i) EXPECT_LT(E[i].irradiance.g, 1e-5) << i;
}

TEST(LineSolve, TimeBoundsEveryPhase) {
  SolveSettings settings;
  settings.error = 0.005, settings.seconds = 1;
  Engine engine(furnishedRoom(), settings);
  const SolveReport report = engine.solve();
  EXPECT_FALSE(report.converged);
  EXPECT_GT(report.counts.lines, 0u);
  EXPECT_TRUE(report.error.estimatedMedian.has_value());
}

TEST(LineSolve, APreviewIsASolutionOfItsOwn) {
  SolveSettings settings;
  Engine engine(furnishedRoom(), settings);
  const SolveReport first = engine.preview();
  EXPECT_FALSE(first.converged);
  EXPECT_GT(lux(measure(engine, {{{1.0, 1.0, 0.0}, {0, 0, 1}}})[0]), 0);
  const SolveReport last = engine.solve();
  EXPECT_TRUE(last.converged);
  EXPECT_GT(last.counts.leafElements, first.counts.leafElements);
}

struct Errors {
  double median, p95;
};
Errors errorsAgainst(const std::filesystem::path& rad, const std::filesystem::path& csv) {
  const Engine engine = solved(loadScene({rad}).scene, 0.05);
  const std::vector<ReferenceValue> values = readReferenceValues(csv);
  std::vector<ProbePoint> points;
  for (const ReferenceValue& v : values) points.push_back(v.point);
  ProbeSettings settings;
  const std::vector<ProbeResult> results = probe(engine.solution(), points, settings);
  std::vector<double> errors;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = gray(Rgb(values[i].irradiance));
    if (expected > 0) errors.push_back(std::abs(gray(Rgb(results[i].irradiance)) / expected - 1));
  }
  const Spread spread = spreadOf(errors);
  return {spread.median, spread.p95};
}

TEST(LineSolve, TheReportKnowsItsError) {
  for (const double error : {0.1, 0.05}) {
    const Engine engine = solved(loadScene({bundledScene("cornell/cornell.rad")}).scene, error);
    const Solution& s = engine.solution().get();
    const hierarchy::LeafTable leaves(s.elements);
    // Leaves by area, each held against meters at points of its own.
    constexpr std::size_t kLeaves = 200, kPoints = 24;
    std::vector<std::size_t> chosen;
    std::vector<ProbePoint> points;
    double area = 0, next = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i)
      if (s.lines.countOf(leaves[i]) > 0) area += s.elements.shape(leaves[i]).area;
    const double step = area / kLeaves;
    area = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (s.lines.countOf(leaves[i]) == 0) continue;
      const hierarchy::LeafSequence sequence(s.elements, s.scene, leaves[i]);
      for (area += s.elements.shape(leaves[i]).area; next < area; next += step) {
        chosen.push_back(i);
        for (std::uint32_t k = 0; k < kPoints; ++k) {
          const hierarchy::PatchPoint x = sequence.point(4096 + k);
          points.push_back({Vec3(x.position), Vec3(x.normal)});
        }
      }
    }
    const std::vector<ProbeResult> meters = probe(engine.solution(), points, {.error = 0.04});
    std::vector<double> differences;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      double mean = 0;
      for (std::size_t p = 0; p < kPoints; ++p) mean += gray(Rgb(meters[k * kPoints + p].irradiance)) / kPoints;
      const hierarchy::ElementLight& l = s.elements.radiometry[leaves[chosen[k]].index()];
      if (mean > 0) differences.push_back(std::abs(gray(l.direct + l.indirect + l.particle) / mean - 1));
    }
    const Spread spread = spreadOf(differences);
    const ErrorEstimate& estimate = s.report.error;
    EXPECT_NEAR(std::log2(*estimate.estimatedMedian / spread.median), 0, 1) << "median at " << error;
    EXPECT_NEAR(std::log2(*estimate.estimatedP95 / spread.p95), 0, 1) << "95th percentile at " << error;
    // What is asked lies between the two.
    EXPECT_LT(spread.median, error);
    EXPECT_LT(error, spread.p95);
  }
}

TEST(LineSolve, CornellBoxesAgreeWithTheReference) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const Errors plain = errorsAgainst(shared / "reference/cornell.rad", shared / "reference/cornell.csv");
  EXPECT_LT(plain.median, 0.01);
  EXPECT_LT(plain.p95, 0.04);
  const Errors caustic =
      errorsAgainst(shared / "reference/cornell-mirror-caustic.rad", shared / "reference/cornell-mirror-caustic.csv");
  EXPECT_LT(caustic.median, 0.01);
  EXPECT_LT(caustic.p95, 0.05);
}

}  // namespace
}  // namespace deltalux
