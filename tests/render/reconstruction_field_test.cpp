#include <gtest/gtest.h>

#include "mesh_scenes.hpp"

namespace deltalux {
using namespace rendering;

namespace {

using test::FieldReader;
using test::MeshScene;
using test::polygon;
using test::square;

constexpr int kLeast = 2, kMost = 6;

Rgb linear(const Vec3f& p) { return {1.0f + p.x + 0.5f * p.y + 0.25f * p.z, 6.0f - p.x - p.y, 1.0f + 0.3f * p.y}; }

Rgb noise(const Vec3f&, const MeshScene& mesh, hierarchy::ElementId e) {
  Rng rng(mesh.elements.key[e.index()]);
  return {static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform())};
}

float largestDifference(const Rgb& a, const Rgb& b) { return maxChannel(glm::abs(a - b)); }

TEST(IrradianceField, ReproducesLinearFieldsUpToTheEdges) {
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(kLeast, kMost, 1);
  mesh.light([](const Vec3f& c, hierarchy::ElementId) { return linear(c); });
  const FieldReader reader{mesh};
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    Vec3 p(rng.uniform(), rng.uniform(), 0);
    if (i % 4 == 0) p[i / 4 % 2] = i / 8 % 2;  // on an edge
    EXPECT_LT(largestDifference(reader.at(PrimitiveId(0), p), linear(Vec3f(p))), 2e-3f) << p.x << " " << p.y;
  }
}

/// Of indirect light, what is within the noise is averaged; an edge of light stays where it is.
TEST(IrradianceField, AveragesNoiseAndKeepsEdges) {
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(4, 6, 1);
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) {
    return (c.x < 0.5f ? 1.0f : 2.0f) * (Rgb(1.0f) + 0.1f * (noise(c, mesh, e) - 0.5f));
  });
  const IrradianceField rough = mesh.field(), quiet = mesh.field(0.05f);
  const hierarchy::SideLocator locator(mesh.elements, mesh.scene);
  Rng rng(3);
  double before = 0, after = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p(rng.uniform(), rng.uniform(), 0);
    if (std::abs(p.x - 0.5) < 0.1) continue;
    const hierarchy::LeafPoint at = locator.locate(locator.side(PrimitiveId(0), 0, true), p);
    const double truth = p.x < 0.5 ? 1 : 2;
    const double a = rough.indirect(at, Vec3f(p)).x / truth - 1, b = quiet.indirect(at, Vec3f(p)).x / truth - 1;
    before += a * a, after += b * b;
    EXPECT_LT(std::abs(b), 0.06);
    EXPECT_EQ(quiet.direct(at, Vec3f(p)), rough.direct(at, Vec3f(p)));
  }
  EXPECT_LT(after, 0.2 * before);
}

/// Leaves whose own rays say that they vary by much are averaged as far as that; others that differ as much are not.
TEST(IrradianceField, AveragesByTheNoiseOfEachLeaf) {
  const auto errorWith = [](float known) {
    MeshScene mesh({square(0, 0)});
    mesh.splitIrregularly(4, 6, 1);
    mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return Rgb(1.0f) + 0.8f * (noise(c, mesh, e) - 0.5f); });
    for (LeafIrradiance& v : mesh.values) v.noise = known;
    const IrradianceField field = mesh.field(0.01f);
    const hierarchy::SideLocator locator(mesh.elements, mesh.scene);
    Rng rng(3);
    double squares = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p(rng.uniform(), rng.uniform(), 0);
      const hierarchy::LeafPoint at = locator.locate(locator.side(PrimitiveId(0), 0, true), p);
      squares += std::pow(field.indirect(at, Vec3f(p)).x - 1, 2);
    }
    return squares;
  };
  EXPECT_LT(errorWith(0.25f), 0.2 * errorWith(0.0f));
}

TEST(IrradianceField, ReproducesLinearFieldsOnSlantedPolygonsWithHoles) {
  // A slanted wall with a window, its hole joined by a seam.
  const auto at = [](double x, double y) { return Vec3(x, y, 0.5 * x); };
  MeshScene mesh({polygon(
      {at(0, 0), at(3, 0), at(3, 2), at(0, 2), at(0, 0), at(1, 0.7), at(1, 1.5), at(2, 1.5), at(2, 0.7), at(1, 0.7)})});
  mesh.splitIrregularly(3, 6, 3);
  mesh.light([](const Vec3f& c, hierarchy::ElementId) { return linear(c); });
  const FieldReader reader{mesh};
  Rng rng(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = samplePoint(mesh.scene.primitives[0].shape, {rng.uniform(), rng.uniform()}).position;
    EXPECT_LT(largestDifference(reader.at(PrimitiveId(0), p), linear(Vec3f(p))), 0.02f) << p.x << " " << p.y;
  }
}

TEST(IrradianceField, ConstantStaysConstantOnEveryShape) {
  MeshScene mesh({square(0, 0),
                  {Sphere{{3, 0, 0}, 1}, MaterialId(0), {}},
                  {Cylinder{{6, 0, 0}, {6, 0, 5}, 0.3}, MaterialId(0), {}},
                  {Cone{{9, 0, 0}, {9, 0, 1}, 1, 0.2}, MaterialId(0), {}},
                  {Ring{{12, 0, 0}, {0, 0, 1}, 0, 1}, MaterialId(0), {}}});
  mesh.splitIrregularly(1, 5, 5);
  mesh.light([](const Vec3f&, hierarchy::ElementId) { return Rgb(2.0f); });
  const FieldReader reader{mesh};
  Rng rng(6);
  for (std::uint32_t k = 0; k < mesh.scene.primitives.size(); ++k) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = pointAt(mesh.scene.primitives[k].shape, {rng.uniform(), rng.uniform()}).position;
      EXPECT_LT(largestDifference(reader.at(PrimitiveId(k), p), Rgb(2.0f)), 1e-4f);
      EXPECT_LT(largestDifference(reader.at(PrimitiveId(k), p, false), Rgb(2.0f)), 1e-4f);
    }
  }
}

TEST(IrradianceField, IsContinuousWhateverTheMesh) {
  // Leaves of sizes 1/4 to 1/64 with independent values: along lines, steps of 1e-5 must change E by little.
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(kLeast, kMost, 7);
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return noise(c, mesh, e); });
  const FieldReader reader{mesh};
  const Vec3 lines[][2] = {{{0, 0.313, 0}, {1, 0.313, 0}}, {{0.25, 0, 0}, {0.25, 1, 0}}, {{0, 0.02, 0}, {1, 0.93, 0}}};
  for (const auto& line : lines) {
    constexpr int kSteps = 100000;
    Rgb last = reader.at(PrimitiveId(0), line[0]);
    float largest = 0, travelled = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const Rgb E = reader.at(PrimitiveId(0), glm::mix(line[0], line[1], double(i) / kSteps));
      largest = std::max(largest, largestDifference(E, last));
      travelled += largestDifference(E, last);
      last = E;
    }
    EXPECT_LT(largest, 0.01f);   // a leaf's step would be 0.3
    EXPECT_GT(travelled, 1.0f);  // the values do change
  }
}

TEST(IrradianceField, IsContinuousAroundSeamsAndOverPoles) {
  MeshScene mesh({{Sphere{{0, 0, 0}, 1}, MaterialId(0), {}},
                  {Cylinder{{5, 0, 0}, {5, 0, 3}, 1}, MaterialId(0), {}},
                  {Ring{{9, 0, 0}, {0, 0, 1}, 0, 1}, MaterialId(0), {}}});
  mesh.splitIrregularly(3, 5, 8);
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return noise(c, mesh, e); });
  const FieldReader reader{mesh};
  constexpr int kSteps = 100000;
  const auto walk = [&](std::uint32_t primitive, const std::function<Vec3(double)>& path) {
    Rgb last = reader.at(PrimitiveId(primitive), path(0));
    float largest = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const Rgb E = reader.at(PrimitiveId(primitive), path(double(i) / kSteps));
      largest = std::max(largest, largestDifference(E, last));
      last = E;
    }
    return largest;
  };
  const auto circle = [](double t) { return Vec3(std::cos(2 * kPi * t), std::sin(2 * kPi * t), 0.0); };
  EXPECT_LT(walk(0, circle), 0.01f);  // equator
  EXPECT_LT(walk(0,
                 [&](double t) {
                   const Vec3 c = circle(t);
                   return Vec3(0.6 * c.x + 1e-9, 0.8 * c.x, c.y);
                 }),
            0.01f);                                                                          // poles
  EXPECT_LT(walk(1, [&](double t) { return Vec3(5, 0, 0.3 + 2 * t) + circle(t); }), 0.01f);  // a screw
  EXPECT_LT(walk(2, [](double t) { return Vec3(9 + 2 * t - 1, 1e-7, 0); }), 0.01f);          // diameter
}

TEST(IrradianceField, StaysWithinWhatTheLeavesDiffer) {
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(kLeast, kMost, 9);
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return noise(c, mesh, e); });
  const FieldReader reader{mesh};
  Rng rng(10);
  float low = 1, high = 0;
  for (int i = 0; i < 20000; ++i) {
    const Rgb E = reader.at(PrimitiveId(0), {rng.uniform(), rng.uniform(), 0});
    low = std::min({low, E.r, E.g, E.b}), high = std::max(high, maxChannel(E));
  }
  EXPECT_GE(low, 0.0f);
  EXPECT_LT(high, 1.5f);
}

/// A ball of eight leaves, lit from one side: those behind a leaf, straight through the ball, tilt nothing.
TEST(IrradianceField, IsSmoothOnABallOfFewLeaves) {
  MeshScene mesh({{Sphere{{0, 0, 0}, 0.088, false}, MaterialId(0), ObjectId()}});
  mesh.splitIrregularly(2, 2, 1);
  mesh.light([](const Vec3f& c, hierarchy::ElementId) { return Rgb(c.y < 0 ? 0.4f : 0.0f); });
  const FieldReader reader{mesh};
  const auto at = [&](double x, double z) {
    return reader.at(PrimitiveId(0), 0.088 * Vec3(x, -std::sqrt(1 - x * x - z * z), z)).x;
  };
  for (int i = -60; i <= 60; ++i) {
    const double a = 0.01 * i;
    for (const auto& [x, z] : {std::pair(a, 0.3), std::pair(0.3, a), std::pair(a, -0.5), std::pair(-0.5, a)}) {
      EXPECT_GT(at(x, z), 0.3f);
      EXPECT_LT(at(x, z), 0.82f);
    }
    EXPECT_NEAR(at(a, 0.3), at(a + 0.01, 0.3), 0.03);
    EXPECT_NEAR(at(0.3, a), at(0.3, a + 0.01), 0.03);
  }
}

/// What all but a sliver of a leaf is worth nobody knows: it says nothing to the leaves around it.
TEST(IrradianceField, LeavesThatAreAllButCoveredTiltNothing) {
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(kLeast, kMost, 9);
  int covered = 0;
  mesh.light([&](const Vec3f&, hierarchy::ElementId e) {
    if (Rng(7, mesh.elements.key[e.index()]).uniform() > 0.05) return Rgb(1.0f);
    mesh.elements.geometry[e.index()].exposed = 0.02f;
    ++covered;
    return Rgb(10.0f);
  });
  EXPECT_GT(covered, 10);
  const FieldReader reader{mesh};
  Rng rng(10);
  for (int i = 0; i < 20000; ++i) {
    const Rgb E = reader.at(PrimitiveId(0), {rng.uniform(), rng.uniform(), 0});
    EXPECT_NEAR(E.x, 1.0f, 1e-4f);
  }
}

TEST(IrradianceField, JoinsPolygonsOfOnePlaneAndNoOthers) {
  // Two squares side by side, one at right angles, and a small one a little above: a picture on a wall.
  MeshScene mesh({square(0, 0), square(1, 0), polygon({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}),
                  polygon({{0.4, 0.4, 0.02}, {0.6, 0.4, 0.02}, {0.6, 0.6, 0.02}, {0.4, 0.6, 0.02}})});
  mesh.splitIrregularly(3, 5, 11);
  const auto primitive = [&](hierarchy::ElementId e) { return mesh.elements.domain[e.index()].primitive.value; };
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return primitive(e) < 2 ? linear(c) : Rgb(100.0f); });
  const FieldReader reader{mesh};
  Rng rng(12);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(2 * rng.uniform(), rng.uniform(), 0);
    EXPECT_LT(largestDifference(reader.at(PrimitiveId(p.x < 1 ? 0 : 1), p), linear(Vec3f(p))), 0.01f);
    const Vec3 q(0, rng.uniform(), rng.uniform());
    EXPECT_NEAR(reader.at(PrimitiveId(2), q).g, 100.0f, 1e-3);
  }
  EXPECT_NEAR(reader.at(PrimitiveId(3), {0.41, 0.5, 0.02}).g, 100.0f, 1e-3);
}

/// The bottom of a closed box on a floor, seen from inside, lies in the floor's plane and faces the same way.
TEST(IrradianceField, DoesNotBlendWithTheInsideOfWhatStandsFlush) {
  MeshScene mesh({square(0, 0), polygon({{0.4, 0.4, 0}, {0.4, 0.6, 0}, {0.6, 0.6, 0}, {0.6, 0.4, 0}})});
  mesh.splitIrregularly(1, 3, 16);
  const auto primitive = [&](hierarchy::ElementId e) { return mesh.elements.domain[e.index()].primitive.value; };
  mesh.light([&](const Vec3f& c, hierarchy::ElementId e) { return primitive(e) == 0 ? linear(c) : Rgb(0.0f); });
  const FieldReader reader{mesh};
  Rng rng(17);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(rng.uniform(), rng.uniform(), 0);
    EXPECT_LT(largestDifference(reader.at(PrimitiveId(0), p), linear(Vec3f(p))), 0.01f);
  }
  EXPECT_EQ(reader.at(PrimitiveId(1), {0.5, 0.5, 0}, false), Rgb(0.0f));
}

TEST(IrradianceField, KeepsTheSidesOfASurfaceApart) {
  MeshScene mesh({square(0, 0)});
  mesh.splitIrregularly(3, 4, 13);
  mesh.light([&](const Vec3f&, hierarchy::ElementId e) { return Rgb(mesh.elements.at(e).front ? 1.0f : 0.0f); });
  const FieldReader reader{mesh};
  EXPECT_EQ(reader.at(PrimitiveId(0), {0.37, 0.61, 0}, true), Rgb(1.0f));
  EXPECT_EQ(reader.at(PrimitiveId(0), {0.37, 0.61, 0}, false), Rgb(0.0f));
}

TEST(IrradianceField, DoesNotLeakUnderAWallThatStandsOnAFloor) {
  const auto build = [](bool wall) {
    std::vector<Primitive> primitives{square(0, 0)};
    if (wall) primitives.push_back(polygon({{0.5, -1, 0}, {0.5, 2, 0}, {0.5, 2, 1}, {0.5, -1, 1}}));
    MeshScene mesh(std::move(primitives));
    mesh.splitIrregularly(3, 5, 14);
    mesh.light([](const Vec3f& c, hierarchy::ElementId) { return Rgb(c.x < 0.5f ? 1.0f : 0.0f); });
    return mesh;
  };
  const MeshScene open = build(false), split = build(true);
  const FieldReader without{open}, with{split};
  Rng rng(15);
  float blurred = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(0.5 + 0.1 * (rng.uniform() - 0.5), rng.uniform(), 0);
    const float truth = p.x < 0.5 ? 1.0f : 0.0f;
    EXPECT_NEAR(with.at(PrimitiveId(0), p).r, truth, 1e-4) << p.x << " " << p.y;
    blurred = std::max(blurred, std::abs(without.at(PrimitiveId(0), p).r - truth));
  }
  EXPECT_GT(blurred, 0.3f);  // where nothing stands, the same leaves blend
}

TEST(IrradianceField, MendsLeavesThatAWallCutsInTwo) {
  // The floor is lit up to a wall at x = 0.47, dark behind it; leaves across it have the mean of both.
  const double wall = 0.47;
  MeshScene mesh({square(0, 0), polygon({{wall, -1, 0}, {wall, 2, 0}, {wall, 2, 1}, {wall, -1, 1}})});
  mesh.splitIrregularly(3, 4, 16);
  mesh.light([&](const Vec3f&, hierarchy::ElementId e) {
    const hierarchy::PatchDomain& d = mesh.elements.domain[e.index()];
    return Rgb(static_cast<float>(std::clamp((wall - d.u0) / (d.u1 - d.u0), 0.0, 1.0)));
  });
  const FieldReader reader{mesh};
  Rng rng(17);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(wall - 1e-3 - 0.1 * rng.uniform(), 0.02 + 0.96 * rng.uniform(), 0);
    EXPECT_NEAR(reader.at(PrimitiveId(0), p).r, 1.0f, 0.15f) << p.x << " " << p.y;
  }
}

}  // namespace
}  // namespace deltalux
