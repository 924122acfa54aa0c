// Caustic textures as triangles: what bilinear interpolation shows is what the textures' own look-up finds.
#include <gtest/gtest.h>

#include "caustics/adaptive_textures.hpp"
#include "caustics/shapes.hpp"
#include "caustics/synthetic.hpp"
#include "mesh_scenes.hpp"
#include "render/solution_mesh/caustic_mesh.hpp"
#include "render/solution_mesh/plane_groups.hpp"
#include "render/solution_mesh/side_shape.hpp"

namespace deltalux {
using namespace rendering;

namespace {

/// Texels as a graphics card reads them: rims are repeated outwards.
struct TextureReader {
  const CausticMesh& mesh;

  glm::vec4 texel(int x, int y) const {
    x = std::clamp(x, 0, mesh.width - 1), y = std::clamp(y, 0, mesh.height - 1);
    return mesh.texels[static_cast<std::size_t>(y * mesh.width + x)];
  }
  Vec2 at(const glm::vec2& texcoord) const { return Vec2(texcoord) * Vec2(mesh.width, mesh.height); }
  bool shows(const glm::vec2& texcoord) const {
    const Vec2 p = glm::floor(at(texcoord));
    return texel(static_cast<int>(p.x), static_cast<int>(p.y)).w > 0.5f;
  }
  Rgb bilinear(const glm::vec2& texcoord) const {
    const Vec2 p = at(texcoord) - 0.5, corner = glm::floor(p), part = p - corner;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    const auto E = [&](int dx, int dy) { return RgbSum(Rgb(texel(x + dx, y + dy))); };
    return Rgb(glm::mix(glm::mix(E(0, 0), E(1, 0), part.x), glm::mix(E(0, 1), E(1, 1), part.x), part.y));
  }
};

/// The texture's own four texels around a chart point all know.
bool allKnown(const caustics::CausticTexture& t, const Vec2& st) {
  const Vec2 corner = glm::floor((st - t.region.lower) / t.region.size() * Vec2(t.width, t.height) - 0.5);
  for (int k = 0; k < 4; ++k) {
    const int x = static_cast<int>(corner.x) + k % 2, y = static_cast<int>(corner.y) + k / 2;
    if (x < 0 || y < 0 || x >= t.width || y >= t.height) return false;
    const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(t.width) + static_cast<std::size_t>(x);
    if (!(t.areas[i] > 0) && isBlack(t.texels[i])) return false;
  }
  return true;
}

SurfacePoint pointOfChart(const Shape& shape, const caustics::Chart& chart, const Vec2& st, const Vec3& position) {
  SurfacePoint p;
  p.position = position;
  if (!chart.closed()) return p;
  const double s = st.x / chart.size.x;
  p.uv.x = s - std::floor(s);
  const auto* sphere = std::get_if<Sphere>(&shape);
  p.uv.y = sphere ? 0.5 * (1 - std::cos(st.y / sphere->radius)) : st.y / chart.size.y;
  return p;
}

class CausticMeshOf : public testing::TestWithParam<test::NamedShape> {
 protected:
  /// A lit patch on the shape, which has both fine and coarse textures.
  void SetUp() override {
    const Shape& shape = GetParam().shape;
    const Vec3 center = samplePoint(shape, {0.3, 0.4}).position;
    const double radius = 0.15 * std::sqrt(area(shape));
    const auto* mesh = std::get_if<Mesh>(&shape);
    const auto impacts = test::drawImpacts(6000, 5, [&](Rng& rng) {
      for (;;) {
        const double u = rng.uniform();
        SurfacePoint p = samplePoint(shape, {u, rng.uniform()});
        if (rng.uniform() > 0.05 && glm::distance(p.position, center) > radius) continue;
        if (mesh) p.uv = parameterWithin(*mesh, p);
        return p;
      }
    });
    const auto made = caustics::makeCausticTextures(shape, impacts, {0.05, 0});
    ASSERT_TRUE(made);
    surface_ = *made;
    surface_.primitive = PrimitiveId(0);
    const test::MeshScene scene({{shape, MaterialId(0), ObjectId()}});
    const SurfacePieces pieces = piecesOf(scene.elements, scene.scene, PrimitiveId(0), true);
    const auto side = shapesOf({&pieces}, scene.scene, touchingDistance(scene.scene, {0}))[0];
    SurfaceMesh triangles;
    triangles.vertices = side->points, triangles.triangles = side->triangles;
    mesh_ = causticMeshOf(surface_, shape, triangles);
  }

  static Vec2 parameterWithin(const Mesh& mesh, const SurfacePoint& p) {
    const auto& [a, b, c] = mesh.triangles[p.triangle];
    const Vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
    const Vec3 d = p.position - mesh.positions[a], n = glm::cross(e1, e2);
    return {glm::dot(glm::cross(d, e2), n) / glm::dot(n, n), glm::dot(glm::cross(e1, d), n) / glm::dot(n, n)};
  }

  caustics::SurfaceCaustics surface_;
  SurfaceCausticMesh mesh_;
};

TEST_P(CausticMeshOf, ShowsWhatTheTexturesHold) {
  const Shape& shape = GetParam().shape;
  ASSERT_EQ(mesh_.textures.size(), surface_.textures.size());
  ASSERT_GT(mesh_.textures.size(), 1u);
  float brightest = 0;
  for (const auto& t : surface_.textures)
    for (const Rgb& E : t.texels) brightest = std::max(brightest, E.r);
  Rng rng(3);
  int compared = 0, shown = 0;
  for (std::size_t k = 0; k < mesh_.textures.size(); ++k) {
    const CausticMesh& m = mesh_.textures[k];
    const caustics::CausticTexture& t = surface_.textures[k];
    const int border = t.closed || t.poleAtStart || t.poleAtEnd ? 1 : 0;
    const caustics::Chart& chart = surface_.charts.all[t.chart];
    for (std::size_t i = 0; i < m.triangles.size(); i += 3)
      for (int repeat = 0; repeat < 4; ++repeat) {
        double u = rng.uniform(), v = rng.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const auto within = [&](const auto& of) {
          return (1 - u - v) * of(m.vertices[m.triangles[i]]) + u * of(m.vertices[m.triangles[i + 1]]) +
                 v * of(m.vertices[m.triangles[i + 2]]);
        };
        const Vec2 texcoord = within([](const CausticMesh::Vertex& x) { return Vec2(x.texcoord); });
        const Vec3 position = within([](const CausticMesh::Vertex& x) { return Vec3(x.position); });
        const TextureReader reader{m};
        if (!reader.shows(glm::vec2(texcoord))) continue;
        ++shown;
        const Vec2 st = t.region.lower +
                        (texcoord * Vec2(m.width, m.height) - Vec2(border)) / Vec2(t.width, t.height) * t.region.size();
        if (!allKnown(t, st) && border == 0) continue;
        ++compared;
        SurfacePoint point = pointOfChart(shape, chart, st, position);
        const auto& ofTriangle = surface_.charts.ofTriangle;  // any triangle tells its chart
        if (!ofTriangle.empty())
          point.triangle =
              static_cast<std::uint32_t>(std::find(ofTriangle.begin(), ofTriangle.end(), t.chart) - ofTriangle.begin());
        const Rgb expected = surface_.irradianceAt(point);
        EXPECT_NEAR(reader.bilinear(glm::vec2(texcoord)).r, expected.r, 2e-4f * brightest)
            << k << ": " << st.x << " " << st.y;
      }
  }
  EXPECT_GT(compared, shown / 2);
  EXPECT_GT(compared, 10);
}

/// At every point one texture shows: together they hold the flux, to what tessellation leaves of the area.
TEST_P(CausticMeshOf, HoldsTheFluxOfTheParticles) {
  double flux = 0;
  Rng rng(4);
  for (const CausticMesh& m : mesh_.textures) {
    const TextureReader reader{m};
    for (std::size_t i = 0; i < m.triangles.size(); i += 3) {
      const auto &a = m.vertices[m.triangles[i]], &b = m.vertices[m.triangles[i + 1]],
                 &c = m.vertices[m.triangles[i + 2]];
      const double size = 0.5 * glm::length(glm::cross(Vec3(b.position - a.position), Vec3(c.position - a.position)));
      const int samples = std::clamp(static_cast<int>(4e4 * size / area(GetParam().shape)), 4, 20000);
      double sum = 0;
      for (int k = 0; k < samples; ++k) {
        float u = static_cast<float>((k + rng.uniform()) / samples), v = static_cast<float>(rng.uniform());
        const float root = std::sqrt(u);
        const glm::vec2 at = (1 - root) * a.texcoord + root * (1 - v) * b.texcoord + root * v * c.texcoord;
        if (reader.shows(at)) sum += reader.bilinear(at).r;
      }
      flux += size * sum / samples;
    }
  }
  EXPECT_NEAR(flux, 1.0, 0.04);
}

INSTANTIATE_TEST_SUITE_P(Shapes, CausticMeshOf, testing::ValuesIn(test::causticShapes()),
                         [](const auto& shape) { return shape.param.name; });

}  // namespace
}  // namespace deltalux
