// Light on pages, as bilinear interpolation reads it, against the mesh.
#include "export/lightmap.hpp"

#include <gtest/gtest.h>

#include "baked_scene.hpp"
#include "base/random.hpp"
#include "export/lightmap_caustics.hpp"
#include "export/lightmap_side_light.hpp"

namespace deltalux::exporting {
namespace {

Rgb slope(double x, double y) { return Rgb(glm::dvec3(1 + x, 2 + y, 1 + 0.5 * x + 0.5 * y)); }

/// E read from the pages at a place of a chart's triangle, given by its second and third corner's weights.
Rgb readAt(const test::BakedScene& scene, std::size_t chart, std::size_t triangle, const Vec2& w) {
  const AtlasChart& c = scene.atlas.charts[chart];
  const Vec2 place = within(c.places[c.corners[3 * triangle]], c.places[c.corners[3 * triangle + 1]],
                            c.places[c.corners[3 * triangle + 2]], w);
  return test::readPage(scene.pages[scene.atlas.places[chart].page], texcoordOf(scene.atlas, chart, place));
}

TEST(Lightmap, HoldsLinearLightExactlyOnASquareUpToItsEdges) {
  const test::BakedScene scene = test::baked(test::squareMesh(test::gridSide(5, 1, slope)), {13, 64, 2});
  ASSERT_EQ(scene.atlas.charts.size(), 1u);
  Rng random(1, 2);
  const AtlasChart& chart = scene.atlas.charts[0];
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (const Vec2& w : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.5, 0), Vec2(0.3, 0.3), Vec2(0.5, 0.5)}) {
      const auto at = [&](std::uint32_t k) {
        return Vec3(scene.mesh.surfaces[0]->vertices[chart.vertices[chart.corners[3 * t + k]]].position);
      };
      const Vec3 p = at(0) + w.x * (at(1) - at(0)) + w.y * (at(2) - at(0));
      EXPECT_NEAR(glm::length(readAt(scene, 0, t, w) - slope(p.x, p.y)), 0, 2e-5);
    }
}

TEST(Lightmap, CarriesLinearLightOnBeyondSlantedEdges) {
  SurfaceMesh side = test::gridSide(6, 1, slope);
  std::vector<std::uint32_t> half;
  for (std::size_t i = 0; i < side.triangles.size(); i += 3) {
    Vec3f middle(0.0f);
    for (std::size_t k = 0; k < 3; ++k) middle += side.vertices[side.triangles[i + k]].position / 3.0f;
    const bool isUpper = middle.y > middle.x, isRound = glm::length(middle - Vec3f(0, 1, 0)) < 0.9f;
    if (isUpper && isRound) half.insert(half.end(), &side.triangles[i], &side.triangles[i] + 3);
  }
  side.triangles = half;
  const test::BakedScene scene = test::baked(test::squareMesh(std::move(side)), {37, 64, 2});
  for (std::size_t chart = 0; chart < scene.atlas.charts.size(); ++chart) {
    const AtlasChart& c = scene.atlas.charts[chart];
    for (std::size_t t = 0; t < c.triangles.size(); ++t)
      for (const Vec2& w : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.5, 0), Vec2(0.5, 0.5), Vec2(0, 0.5)}) {
        const auto at = [&](std::uint32_t k) {
          return Vec3(scene.mesh.surfaces[0]->vertices[c.vertices[c.corners[3 * t + k]]].position);
        };
        const Vec3 p = at(0) + w.x * (at(1) - at(0)) + w.y * (at(2) - at(0));
        EXPECT_NEAR(glm::length(readAt(scene, chart, t, w) - slope(p.x, p.y)), 0, 1e-4);
      }
  }
}

TEST(Lightmap, IsNotDarkenedBesideWhatNoLightReaches) {
  // A wall stands on x < 0.5: the triangles below it have vertices of their own, without light.
  SurfaceMesh side = test::gridSide(4, 1, [](double, double) { return Rgb(3.0f); });
  for (std::size_t i = 0; i < side.triangles.size(); i += 3) {
    float x = 0;
    for (std::size_t k = 0; k < 3; ++k) x += side.vertices[side.triangles[i + k]].position.x / 3;
    if (x > 0.5f) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      side.vertices.push_back(side.vertices[side.triangles[i + k]]);
      side.vertices.back().direct = Rgb(0.0f);
      side.triangles[i + k] = static_cast<std::uint32_t>(side.vertices.size() - 1);
    }
  }
  const test::BakedScene scene = test::baked(test::squareMesh(std::move(side)), {21, 64, 2});
  const AtlasChart& c = scene.atlas.charts[0];
  for (std::size_t t = 0; t < c.triangles.size(); ++t) {
    if (isBlack(scene.mesh.surfaces[0]->vertices[c.vertices[c.corners[3 * t]]].direct)) continue;
    for (const Vec2& w : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.3, 0.3)})
      EXPECT_NEAR(readAt(scene, 0, t, w).r, 3, 1e-5);
  }
}

/// Relative differences of what pages hold from mesh and caustics at random points of lit triangles, by area.
std::vector<double> differences(const test::BakedScene& scene, int count) {
  struct Place {
    std::size_t chart, triangle;
  };
  std::vector<Place> places;
  std::vector<double> cumulative;
  double area = 0, mean = 0;
  for (std::size_t c = 0; c < scene.atlas.charts.size(); ++c)
    for (std::size_t t = 0; t < scene.atlas.charts[c].triangles.size(); ++t) {
      const AtlasChart& chart = scene.atlas.charts[c];
      const SurfaceMesh& side = *scene.mesh.surfaces[chart.side];
      const auto v = [&](std::uint32_t k) -> const MeshVertex& {
        return side.vertices[chart.vertices[chart.corners[3 * t + k]]];
      };
      const double own =
          0.5 * double(glm::length(glm::cross(v(1).position - v(0).position, v(2).position - v(0).position)));
      mean += own * gray((irradianceOf(v(0)) + irradianceOf(v(1)) + irradianceOf(v(2))) / 3.0f);
      places.push_back({c, t}), cumulative.push_back(area += own);
    }
  mean /= area;
  std::vector<double> found;
  Rng random(5, 6);
  for (int i = 0; i < count; ++i) {
    const auto pick =
        std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * area) - cumulative.begin();
    const Place p = places[std::min(static_cast<std::size_t>(pick), places.size() - 1)];
    Vec2 w(random.uniform(), random.uniform());
    if (w.x + w.y > 1) w = 1.0 - w;
    const AtlasChart& chart = scene.atlas.charts[p.chart];
    const SurfaceMesh& side = *scene.mesh.surfaces[chart.side];
    const auto v = [&](std::uint32_t k) -> const MeshVertex& {
      return side.vertices[chart.vertices[chart.corners[3 * p.triangle + k]]];
    };
    Rgb E = within(irradianceOf(v(0)), irradianceOf(v(1)), irradianceOf(v(2)), glm::vec2(w));
    const Vec3f position = within(v(0).position, v(1).position, v(2).position, glm::vec2(w));
    if (const auto& caustics = scene.mesh.caustics[chart.side]; caustics && !caustics->textures.empty())
      E += LightmapCaustics(*caustics).at(position, 1e-4f);
    const double found1 = gray(readAt(scene, p.chart, p.triangle, w)), wanted = gray(E);
    found.push_back(std::abs(found1 - wanted) / std::max(wanted, 0.05 * mean));
  }
  return found;
}

TEST(Lightmap, OfASolvedSceneIsTheMeshsAtRandomPoints) {
  const test::BakedScene scene = test::baked(test::meshOf(test::everythingSolved()), {60, 2048, 2});
  const test::Spread spread = test::spreadOf(differences(scene, 4000));
  EXPECT_LT(spread.median, 0.005);
  EXPECT_LT(spread.p95, 0.08);
}

TEST(Lightmap, ComesNearerToTheMeshWithMoreTexels) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  const double coarse = test::spreadOf(differences(test::baked(mesh, {15, 2048, 2}), 4000)).p95;
  const double fine = test::spreadOf(differences(test::baked(mesh, {120, 4096, 2}), 4000)).p95;
  EXPECT_LT(fine, 0.5 * coarse);
}

}  // namespace
}  // namespace deltalux::exporting
