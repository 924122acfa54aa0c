// The mesh of a page: what several groups of lights have in common, what each adds, and what is drawn how.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/solution_reader.hpp>

#include "export/page_mesh.hpp"
#include "support/solution_scenes.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace exporting;

struct TwoGroups {
  std::vector<LightGroup> groups;
  std::vector<SolutionMesh> meshes;

  /// The lights of one solution as two groups, the first light alone; both with all of the light.
  explicit TwoGroups(Scene scene) {
    Engine engine(std::move(scene), test::coarse());
    engine.solve();
    const SolutionMesh mesh = SolutionReader(engine.solution()).mesh();
    meshes = {mesh, mesh};
    groups = {{"first", {LightId(0)}}, {"others", {}}};
    for (std::size_t i = 1; i < mesh.scene->lights.size(); ++i) groups[1].lights.emplace_back(i);
  }
};

TEST(PageMesh, HasEveryTriangleOfTheSolutionOnce) {
  const TwoGroups two(test::oneOfEverything());
  const PageMesh page = pageMesh(two.groups, two.meshes);
  std::size_t vertices = 0, triangles = 0, passing = 0;
  for (const auto& s : two.meshes[0].surfaces)
    if (s) {
      vertices += s->vertices.size(), triangles += s->triangles.size();
      if (!isBlack(s->transmittance)) passing += s->triangles.size();
    }
  EXPECT_LE(page.vertices.size(), vertices);  // less those of outlines alone
  std::size_t drawn = 0, behind = 0;
  for (const PageDraw& d : page.draws) {
    EXPECT_EQ(d.first, drawn);
    drawn += d.count;
    if (d.kind == PageDraw::Kind::Behind) behind += d.count;
  }
  EXPECT_EQ(drawn, page.triangles.size());
  EXPECT_EQ(behind, passing);
  EXPECT_EQ(drawn - behind, triangles);
  EXPECT_LT(*std::ranges::max_element(page.triangles), vertices);
}

TEST(PageMesh, TellsPanesMirrorsAndTextures) {
  const TwoGroups two(test::oneOfEverything());
  const PageMesh page = pageMesh(two.groups, two.meshes);
  const auto has = [&](auto predicate) { return std::ranges::any_of(page.draws, predicate); };
  EXPECT_TRUE(has([](const PageDraw& d) { return d.pane && d.pane->index == 1.52f; }));
  EXPECT_TRUE(has([](const PageDraw& d) { return d.pane && d.pane->index == 1.33f; }));
  EXPECT_TRUE(has([](const PageDraw& d) { return d.texture.valid(); }));
  EXPECT_TRUE(has([](const PageDraw& d) { return d.kind == PageDraw::Kind::Behind; }));
}

TEST(PageMesh, RadianceCountsForTheGroupThatSendsIt) {
  TwoGroups two(test::oneOfEverything());
  ASSERT_TRUE(std::holds_alternative<AreaLight>(two.meshes[0].scene->lights[0].emitter));
  const PageMesh page = pageMesh(two.groups, two.meshes);
  ASSERT_FALSE(page.emission.empty());
  for (const PageEmission& e : page.emission) {
    EXPECT_EQ(e.group, std::size_t{0});
    EXPECT_GT(gray(e.radiance), 0);
  }
}

TEST(PageMesh, LayersAreTheVerticesLight) {
  const TwoGroups two(test::oneOfEverything());
  const PageMesh page = pageMesh(two.groups, two.meshes);
  const std::vector<Rgb> layer = pageLayer(page, 1, two.meshes[1]);
  ASSERT_EQ(layer.size(), page.vertices.size());
  for (const PageMesh::Side& side : page.sides) {
    const SurfaceMesh& mesh = *two.meshes[1].surfaces[side.side];
    for (std::uint32_t i = 0; i < side.count; ++i) {
      const MeshVertex& v = mesh.vertices[page.source[1][side.first + i]];
      const Rgb E = v.direct + v.indirect + v.particle;
      EXPECT_EQ(layer[side.first + i], E);
      EXPECT_EQ(page.vertices[side.first + i].position, v.position);
    }
  }
}

TEST(PageMesh, VerticesAreSharedWhereEveryGroupSharesThem) {
  TwoGroups two(test::oneOfEverything());
  const auto at =
      std::ranges::find_if(two.meshes[1].surfaces, [](const auto& s) { return s && s->triangles.size() > 6; });
  // In the second group's mesh a corner has a vertex of its own, in other light.
  auto other = std::make_shared<SurfaceMesh>(**at);
  const std::uint32_t corner = other->triangles[0];
  const auto uses = std::ranges::count(other->triangles, corner);
  other->triangles[0] = static_cast<std::uint32_t>(other->vertices.size());
  other->vertices.push_back(other->vertices[corner]);
  other->vertices.back().direct += Rgb(5.0f);
  *at = other;
  const PageMesh page = pageMesh(two.groups, two.meshes);
  const std::vector<Rgb> first = pageLayer(page, 0, two.meshes[0]), second = pageLayer(page, 1, two.meshes[1]);
  const auto side =
      std::ranges::find(page.sides, std::uint32_t(at - two.meshes[1].surfaces.begin()), &PageMesh::Side::side);
  ASSERT_NE(side, page.sides.end());
  EXPECT_EQ(side->count, other->vertices.size() - (uses == 1 ? 1 : 0));
  std::size_t differ = 0;
  for (std::size_t v = 0; v < first.size(); ++v) differ += glm::length(second[v] - first[v]) > 4.0f;
  EXPECT_EQ(differ, 1u);
}

TEST(PageMesh, GroupsOfDifferentMeshesAreOneError) {
  TwoGroups two(test::oneOfEverything());
  const auto at = std::ranges::find_if(two.meshes[1].surfaces, [](const auto& s) { return s && !s->vertices.empty(); });
  auto other = std::make_shared<SurfaceMesh>(**at);
  other->vertices[0].position.x += 1;
  *at = other;
  EXPECT_THROW(pageMesh(two.groups, two.meshes), InputError);
  *at = nullptr;
  EXPECT_THROW(pageMesh(two.groups, two.meshes), InputError);
}

TEST(PageMesh, ALargeFlatMirrorIsOneDraw) {
  Scene scene;
  const MaterialId silver = test::addMaterial(scene, "silver", Mirror{Rgb(0.9f)});
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.5f));
  test::addBox(scene, white, Vec3(0), Vec3(3, 3, 3), true);
  test::addPolygon(scene, silver, {{1, 0.01, 1}, {1, 0.01, 2}, {2, 0.01, 2}, {2, 0.01, 1}});
  test::addPolygon(scene, silver, {{1, 0.02, 0.1}, {1, 0.02, 0.2}, {1.1, 0.02, 0.2}, {1.1, 0.02, 0.1}});
  test::addLight(scene, PointLight{{1.5, 1.5, 2}, Rgb(1.0f)});
  const PageMesh page = pageMesh(TwoGroups(scene).groups, TwoGroups(scene).meshes);
  std::vector<PageMirror> mirrors;
  for (const PageDraw& d : page.draws)
    if (d.mirror) mirrors.push_back(*d.mirror);
  ASSERT_EQ(mirrors.size(), 1u);
  EXPECT_NEAR(mirrors[0].plane.y, 1, 1e-9);
  EXPECT_NEAR(mirrors[0].plane.w, 0.01, 1e-9);
}

}  // namespace
}  // namespace deltalux
