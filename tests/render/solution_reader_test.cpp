// Snapshots of a solution that changes: what is in them, what they share, and what they say has changed.
#include <gtest/gtest.h>

#include <deltalux/solution_reader.hpp>
#include <limits>
#include <stdexcept>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "render/reader_state.hpp"
#include "support/furnished_room.hpp"
#include "support/solved.hpp"

namespace deltalux {

namespace {

Engine furnished() { return test::solved(test::furnishedRoom(), 0.15); }

bool sameSide(const SurfaceMesh& a, const SurfaceMesh& b) {
  return a.primitive == b.primitive && a.front == b.front && a.albedo == b.albedo &&
         a.transmittance == b.transmittance && a.radiance == b.radiance && a.triangles == b.triangles &&
         a.outlines == b.outlines &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](const MeshVertex& v, const MeshVertex& w) {
                      return v.position == w.position && v.normal == w.normal && v.uv == w.uv && v.direct == w.direct &&
                             v.indirect == w.indirect && v.particle == w.particle;
                    });
}

bool sameSide(const SurfaceCausticMesh& a, const SurfaceCausticMesh& b) {
  return std::equal(a.textures.begin(), a.textures.end(), b.textures.begin(), b.textures.end(),
                    [](const CausticMesh& s, const CausticMesh& t) {
                      return s.width == t.width && s.height == t.height && s.texels == t.texels &&
                             s.triangles == t.triangles && s.vertices.size() == t.vertices.size();
                    });
}

template <class Side>
bool isEmptySide(const std::shared_ptr<const Side>& s) {
  if constexpr (std::is_same_v<Side, SurfaceMesh>) return !s || s->triangles.empty();
  if constexpr (std::is_same_v<Side, SurfaceCausticMesh>) return !s || s->textures.empty();
}

/// Bit by bit, but for versions; what is gone may be empty or null.
template <class Side>
bool sameSides(const std::vector<std::shared_ptr<const Side>>& a, const std::vector<std::shared_ptr<const Side>>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& s, const auto& t) {
    if (isEmptySide(s) || isEmptySide(t)) return isEmptySide(s) && isEmptySide(t);
    return sameSide(*s, *t);
  });
}

bool sameMesh(const SolutionMesh& a, const SolutionMesh& b) {
  return sameSides(a.surfaces, b.surfaces) && sameSides(a.caustics, b.caustics);
}

TransformObject moved(const std::string& object, const Vec3& by) {
  TransformObject edit;
  edit.object = object;
  edit.matrix[3] = glm::dvec4(by, 1);
  return edit;
}

std::vector<std::size_t> sidesOf(const Scene& scene, const std::string& object) {
  std::vector<std::size_t> sides;
  for (const PrimitiveId p : primitivesOf(scene, findObjects(scene, object).at(0)))
    for (const bool front : {true, false}) sides.push_back(SolutionMesh::side(p, front));
  return sides;
}

TEST(SolutionReader, NothingChangesNothing) {
  const Engine engine = furnished();
  SolutionReader reader(engine.solution());
  const SolutionMesh first = reader.mesh();
  EXPECT_NO_THROW(validate(first));
  EXPECT_EQ(first.version, 1u);
  // All but the inside of the glass ball.
  EXPECT_EQ(changedSince(first, 0).shapes.size(), 2 * engine.solution().scene().primitives.size() - 1);
  reader.refresh();
  const SolutionMesh second = reader.mesh();
  EXPECT_EQ(second.version, 2u);
  EXPECT_EQ(second.scene, first.scene);
  for (std::size_t i = 0; i < first.surfaces.size(); ++i) EXPECT_EQ(second.surfaces[i], first.surfaces[i]);
  for (std::size_t i = 0; i < first.caustics.size(); ++i) EXPECT_EQ(second.caustics[i], first.caustics[i]);
  const MeshChange change = changedSince(second, 1);
  EXPECT_TRUE(change.shapes.empty() && change.lights.empty() && change.caustics.empty());
}

TEST(SolutionReader, ADimmedLampChangesLightAndNoShape) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  const SolutionMesh before = reader.mesh();
  engine.apply(ScaleLight{"globe", 0.9f});
  engine.update();
  reader.refresh();
  const SolutionMesh after = reader.mesh();
  EXPECT_NO_THROW(validate(after));
  const MeshChange change = changedSince(after, 1);
  EXPECT_GT(change.lights.size(), 6u);
  // Patches on which something stands have vertices of their own or not, as their light has it; most sides have none.
  std::size_t whole = 0;
  for (std::size_t i = 0; i < after.surfaces.size(); ++i)
    if (after.surfaces[i] && after.surfaces[i]->shapeVersion == 1 && after.surfaces[i]->lightVersion == 2) ++whole;
  EXPECT_GT(whole, change.lights.size() / 2);
  for (const std::size_t side : sidesOf(engine.solution().scene(), "globe")) {
    if (!after.surfaces[side]) continue;
    EXPECT_EQ(after.surfaces[side]->shapeVersion, 1u);
    EXPECT_NEAR(after.surfaces[side]->radiance.r, 0.9f * before.surfaces[side]->radiance.r, 1e-4f);
  }
}

TEST(SolutionReader, AMovedObjectHasOtherShapesAndFarOnesHaveNot) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  const SolutionMesh before = reader.mesh();
  const auto westOf = [](const SolutionMesh& mesh) {
    float x = std::numeric_limits<float>::infinity();
    for (const std::size_t side : sidesOf(*mesh.scene, "pot"))
      for (const auto& vertex : mesh.surfaces[side]->vertices) x = std::min(x, vertex.position.x);
    return x;
  };
  const float west = westOf(before);
  engine.apply(moved("pot", {0.2, 0.1, 0}));
  engine.update();
  reader.refresh();
  const SolutionMesh after = reader.mesh();
  EXPECT_NO_THROW(validate(after));
  for (const std::size_t side : sidesOf(*after.scene, "pot")) EXPECT_EQ(after.surfaces[side]->shapeVersion, 2u);
  for (const char* object : {"mirror", "globe", "ball"})
    for (const std::size_t side : sidesOf(*after.scene, object)) {
      if (!after.surfaces[side]) continue;
      EXPECT_EQ(after.surfaces[side]->shapeVersion, 1u) << object;
    }
  // The snapshot before is as it was.
  EXPECT_EQ(westOf(before), west);
  EXPECT_NEAR(westOf(after), west + 0.2f, 1e-4f);
  EXPECT_NE(before.scene, after.scene);
}

TEST(SolutionReader, WhatIsRemovedIsGoneAndComesBack) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  reader.mesh();
  const auto sides = sidesOf(engine.solution().scene(), "box");
  const Restore back = engine.apply(RemoveObject{"box"});
  engine.update();
  reader.refresh();
  const SolutionMesh without = reader.mesh();
  EXPECT_NO_THROW(validate(without));
  const std::vector<std::size_t> gone = changedSince(without, 1).shapes;
  for (const std::size_t side : sides) {
    EXPECT_TRUE(std::binary_search(gone.begin(), gone.end(), side));
    EXPECT_TRUE(isEmptySide(without.surfaces[side]));
  }
  engine.apply(back);
  engine.update();
  reader.refresh();
  const SolutionMesh again = reader.mesh();
  for (const std::size_t side : sides) EXPECT_FALSE(isEmptySide(again.surfaces[side]));
}

/// However a reader came to where it is, its snapshot is the one that a new reader makes; so in every frame of a drag.
TEST(SolutionReader, RefreshedIsAsGoodAsNew) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  reader.mesh();
  const auto compare = [&](const char* what) {
    reader.refresh();
    const SolutionMesh mesh = reader.mesh();
    EXPECT_NO_THROW(validate(mesh)) << what;
    EXPECT_TRUE(sameMesh(mesh, SolutionReader(engine.solution()).mesh())) << what;
    // Patches follow when there is time; what is seen is where the scene has it.
    for (const auto& side : mesh.surfaces) {
      if (!side || side->vertices.empty() || std::holds_alternative<Sphere>((*mesh.scene)[side->primitive].shape))
        continue;
      Box box;
      for (const MeshVertex& v : side->vertices) box.extend(Vec3(v.position));
      const Box shape = bounds((*mesh.scene)[side->primitive].shape);
      EXPECT_LT(glm::length(box.center() - shape.center()), 0.01 * shape.diagonal() + 1e-4) << what;
    }
  };
  engine.select("pot");
  for (int i = 0; i < 4; ++i) {
    engine.apply(moved("pot", {0.05, 0.02, 0}));
    engine.frame(5);
    compare("in motion");
  }
  engine.update();
  compare("at rest");
  engine.apply(ColourLight{"spot", Rgb(1.0f, 0.5f, 0.2f)});
  engine.update();
  compare("coloured");
  engine.apply(RemoveObject{"box"});
  engine.update();
  compare("removed");
  engine.apply(SetMaterial{"wood", Rgb(0.7f, 0.3f, 0.1f), {}});
  engine.update();
  compare("painted");
}

TEST(SolutionReader, LeavesWhatDoesNotShowAsItWas) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  const SolutionMesh before = reader.mesh();
  engine.apply(ScaleLight{"globe", 0.999f});
  engine.update();
  reader.refresh(SolutionReader::kVisibleStep);
  const SolutionMesh shown = reader.mesh();
  std::size_t others = 0;
  for (std::size_t i = 0; i < shown.surfaces.size(); ++i)
    if (shown.surfaces[i] != before.surfaces[i]) ++others;
  EXPECT_LE(others, sidesOf(*shown.scene, "globe").size());  // what shines looks otherwise
  reader.refresh();
  const SolutionMesh exact = reader.mesh();
  EXPECT_TRUE(sameMesh(exact, SolutionReader(engine.solution()).mesh()));
  EXPECT_GT(changedSince(exact, 2).lights.size(), shown.surfaces.size() / 3);
}

/// However many refreshes there are in a row, what is shown does not drift from what is.
TEST(SolutionReader, ShowsWhatIsThereWithinTheTolerance) {
  constexpr float kTolerance = 0.02f;
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  reader.mesh();
  engine.select("pot");
  for (int i = 0; i < 6; ++i) {
    engine.apply(moved("pot", {0.03, 0.02, 0}));
    engine.frame(5);
    reader.refresh(kTolerance);
    const SolutionMesh shown = reader.mesh(), exact = SolutionReader(engine.solution()).mesh();
    EXPECT_NO_THROW(validate(shown));
    std::vector<float> apart;  // of its light
    for (std::size_t side = 0; side < shown.surfaces.size(); ++side) {
      if (isEmptySide(exact.surfaces[side])) continue;
      const auto &a = shown.surfaces[side]->vertices, &b = exact.surfaces[side]->vertices;
      if (a.size() != b.size()) continue;  // torn otherwise
      for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].position, b[k].position);
        const Rgb E = b[k].direct + b[k].indirect + b[k].particle;
        if (!isBlack(E))
          apart.push_back(maxChannel(glm::abs(a[k].direct + a[k].indirect + a[k].particle - E)) / maxChannel(E));
      }
    }
    ASSERT_GT(apart.size(), 1000u);
    std::ranges::sort(apart);
    // Fits and filters take light from several patches.
    EXPECT_LT(apart[apart.size() * 99 / 100], 2 * kTolerance);
  }
}

TEST(SolutionReader, MeshesDoNotDependOnThreads) {
  const Engine engine = furnished();
  const auto with = [&](std::size_t threads) {
    const ThreadLimit limit(threads);
    return SolutionReader(engine.solution()).mesh();
  };
  EXPECT_TRUE(sameMesh(with(1), with(3)));
}

/// Light interpolated over the triangles is that of the reconstruction, and on average that of the patches.
TEST(SolutionReader, TrianglesShowTheReconstructedLight) {
  const Engine engine = furnished();
  const Solution& s = engine.solution().get();
  SolutionReader reader(engine.solution());
  const SolutionMesh mesh = reader.mesh();
  const rendering::Reconstruction& r = *reader.state().reconstruction;
  ProbeSettings bare;
  bare.mesh = true;
  Rng rng(5);
  double off = 0, sum = 0, patches = 0, particles = 0;
  for (const auto& side : mesh.surfaces) {
    if (!side) continue;
    const bool lit = s.elements.side(side->primitive, 0, side->front).valid();
    for (std::size_t i = 0; i < side->triangles.size(); i += 3) {
      const MeshVertex& a = side->vertices[side->triangles[i]];
      const MeshVertex& b = side->vertices[side->triangles[i + 1]];
      const MeshVertex& c = side->vertices[side->triangles[i + 2]];
      if (!lit) {
        EXPECT_TRUE(isBlack(a.direct + a.indirect + a.particle));
        continue;
      }
      const float u = static_cast<float>(rng.uniform()), v = static_cast<float>(rng.uniform()) * (1 - u);
      const Vec3 p((1 - u - v) * a.position + u * b.position + v * c.position);
      const auto total = [](const MeshVertex& w) { return RgbSum(w.direct + w.indirect + w.particle); };
      const RgbSum E = double(1 - u - v) * total(a) + double(u) * total(b) + double(v) * total(c);
      const hierarchy::LeafPoint at = r.locator.locate(r.locator.side(side->primitive, 0, side->front), p);
      const double size = 0.5 * glm::length(glm::cross(b.position - a.position, c.position - a.position));
      const RgbSum field = RgbSum(r.field.direct(at, Vec3f(p)) + r.field.indirect(at, Vec3f(p)));
      off += size * gray(glm::abs(E - field)), sum += size * gray(field);
      particles += gray(double(1 - u - v) * RgbSum(a.particle));
      const hierarchy::ElementLight& l = s.elements.radiometry[at.leaf.index()];
      const bool textured = s.caustics.of(side->primitive, side->front) != nullptr;
      patches += size * gray(l.direct + l.indirect + (textured ? Rgb(0.0f) : l.particle));
    }
  }
  EXPECT_LT(off, 0.02 * sum);
  EXPECT_NEAR(patches / sum, 1.0, 0.02);
  EXPECT_GT(particles, 0.0);  // the mirror's and the pot's, where no texture shows them
}

/// A closed room whose walls shine: E is the same everywhere, M / (1 - rho).
TEST(SolutionReader, AFurnaceIsEven) {
  Scene scene;
  const MaterialId shining = test::addMaterial(scene, "shining", test::lambert(0.5f), Emission{Rgb(1.0f), false, {}});
  test::addBox(scene, shining, {0, 0, 0}, {4, 4, 3}, true);
  const Engine engine = test::solved(std::move(scene), 0.05);
  SolutionReader reader(engine.solution());
  const SolutionMesh mesh = reader.mesh();
  int vertices = 0;
  for (const auto& side : mesh.surfaces) {
    if (!side->front) continue;
    EXPECT_EQ(side->radiance, Rgb(1.0f));
    EXPECT_EQ(side->albedo, Rgb(0.5f));
    for (const MeshVertex& v : side->vertices) {
      EXPECT_NEAR((v.direct + v.indirect + v.particle).g, 2 * kPi, 0.1 * 2 * kPi);
      ++vertices;
    }
  }
  EXPECT_GE(vertices, 6 * 5);
}

TEST(SolutionReader, PicksWhatIsMetFirst) {
  const Engine engine = furnished();
  const SolutionReader reader(engine.solution());
  const auto hit = reader.pick({1.5, 1.7, 2.0}, {0, 0, -2});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position.z, 0.75, 1e-5);
  EXPECT_NEAR(hit->distance, 1.25, 1e-5);
  EXPECT_NEAR(hit->normal.z, 1.0, 1e-6);
  EXPECT_TRUE(hit->front);
  EXPECT_FALSE(reader.pick({10, 10, 10}, {1, 0, 0}));
}

TEST(SolutionReader, ProbesAsProbeDoes) {
  Engine engine = furnished();
  SolutionReader reader(engine.solution());
  const std::vector<ProbePoint> points{{{1, 3, 0}, {0, 0, 1}}, {{1.5, 1.7, 0.75}, {0, 0, 1}}, {{1, 1, 1.5}, {0, 0, 1}}};
  const auto compare = [&] {
    for (const bool bare : {false, true}) {
      ProbeSettings settings;
      settings.mesh = bare, settings.error = 0.05;
      const auto expected = probe(engine.solution(), points, settings), found = reader.probe(points, settings);
      for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(found[i].irradiance, expected[i].irradiance);
    }
  };
  compare();
  engine.apply(ScaleLight{"globe", 0.5f});
  engine.update();
  reader.refresh();
  compare();
}

TEST(SolutionReader, ValidateFindsDamage) {
  const Engine engine = furnished();
  const SolutionMesh sound = SolutionReader(engine.solution()).mesh();
  const auto refuses = [&](const std::function<void(SurfaceMesh&)>& damage) {
    SolutionMesh mesh = sound;
    SurfaceMesh side = *mesh.surfaces[0];
    damage(side);
    mesh.surfaces[0] = std::make_shared<const SurfaceMesh>(side);
    EXPECT_THROW(validate(mesh), std::logic_error);
  };
  refuses([](SurfaceMesh& s) { s.triangles[4] = static_cast<std::uint32_t>(s.vertices.size()); });
  refuses([](SurfaceMesh& s) { s.triangles.pop_back(); });
  refuses([](SurfaceMesh& s) { s.outlines[0] = 1u << 30; });
  refuses([](SurfaceMesh& s) { s.vertices[1].normal *= 1.1f; });
  refuses([](SurfaceMesh& s) { s.vertices[1].position.x = std::nanf(""); });
  refuses([](SurfaceMesh& s) { s.vertices[1].direct.g = -1; });
  refuses([](SurfaceMesh& s) { s.lightVersion = 99; });
  refuses([](SurfaceMesh& s) { s.front = !s.front; });
  SolutionMesh mesh = sound;
  mesh.caustics.pop_back();
  EXPECT_THROW(validate(mesh), std::logic_error);
  for (std::size_t i = 0; i < sound.caustics.size(); ++i) {
    if (!sound.caustics[i]) continue;
    SurfaceCausticMesh side = *sound.caustics[i];
    side.textures[0].texels[0].w = 0.5f;
    mesh = sound;
    mesh.caustics[i] = std::make_shared<const SurfaceCausticMesh>(side);
    EXPECT_THROW(validate(mesh), std::logic_error);
  }
}

}  // namespace
}  // namespace deltalux
