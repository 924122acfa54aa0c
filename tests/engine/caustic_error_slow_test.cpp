// What probes read from caustic textures against the reference integrator: the error falls as particles grow.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

#include "render/caustic_light.hpp"
#include "render/irradiance_field.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

struct Figure {
  const char* name;
  const char* scene;
  const char* object;
  Vec2 lower, upper;  // part of the surface's parameters that the caustic lies in
  double order;       // that the error must fall with, at least

  friend std::ostream& operator<<(std::ostream& out, const Figure& f) { return out << f.name; }
};

constexpr int kAcross = 20;        // points
constexpr double kFewest = 20000;  // particles

Scene sceneOf(const Figure& f) { return loadScene({std::string(DELTALUX_SOURCE_DIR) + "/scenes/" + f.scene}).scene; }

std::vector<ProbePoint> pointsOf(const Figure& f, const Scene& scene) {
  const PrimitiveId primitive = primitivesOf(scene, findObjects(scene, f.object).at(0)).at(0);
  std::vector<ProbePoint> points;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const Vec2 part = (Vec2(i % kAcross, i / kAcross) + 0.5) / double(kAcross);
    const SurfacePoint p = pointAt(scene[primitive].shape, f.lower + part * (f.upper - f.lower));
    points.push_back({p.position, p.normal});
  }
  return points;
}

class CausticErrorOf : public testing::TestWithParam<Figure> {};

TEST_P(CausticErrorOf, FallsInOrderWithTheParticles) {
  const Scene scene = sceneOf(GetParam());
  const std::vector<ProbePoint> points = pointsOf(GetParam(), scene);
  ReferenceSettings reference;
  reference.samples = 1024;
  const std::vector<ProbeResult> truth = ReferenceIntegrator(scene, reference).probe(points);
  std::vector<double> errors;
  for (const double particles : {kFewest, 4 * kFewest, 16 * kFewest}) {
    SolveSettings settings;
    settings.particles = static_cast<std::uint64_t>(particles);
    Engine engine(scene, settings);
    engine.solve();
    ASSERT_GT(engine.solution().report().counts.causticTextures, 0u);
    ProbeSettings precise;
    precise.error = 0.01;
    const std::vector<ProbeResult> shown = probe(engine.solution(), points, precise);
    double squares = 0, mean = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double noise = gray(truth[i].standardError), E = gray(truth[i].irradiance);
      const double d = gray(shown[i].irradiance) - E;
      squares += d * d - noise * noise, mean += E;
    }
    const double count = static_cast<double>(points.size());
    errors.push_back(std::sqrt(squares / count) / (mean / count));
    RecordProperty("error" + std::to_string(errors.size()), std::to_string(errors.back()));
  }
  // At best n^-1/2 where light is even, n^-1/3 where it is smooth, n^-1/4 at edges. The light at the ring's caustic
  // curve grows without bound: the squares of what no texel resolves fall more slowly still.
  const double slope = std::log(errors[2] / errors[0]) / std::log(16.0);
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_LT(errors[2], errors[1]);
  EXPECT_LT(slope, -GetParam().order) << errors[0] << " " << errors[1] << " " << errors[2];
  EXPECT_GT(slope, -0.6) << errors[0] << " " << errors[1] << " " << errors[2];
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, CausticErrorOf,
    testing::Values(
        Figure{"ring", "ring/ring.rad", "table", {0.41, 0.41}, {0.59, 0.59}, 0.12},
        Figure{"cornell", "cornell-caustic/cornell-caustic.rad", "short_block.top", {0.2, 0.2}, {0.8, 0.8}, 0.25}),
    [](const auto& test) { return test.param.name; });

/// What a solution's mesh shows of its particles, smoothed.
class MeshLight {
 public:
  explicit MeshLight(const Solution& s)
      : locator_(s.elements, s.scene), field_(s.elements, s.scene, *s.tracer, particlesOf(s.elements)) {}

  double at(PrimitiveId primitive, const Vec3& p) const {
    return gray(field_.indirect(locator_.locate(locator_.side(primitive, 0, true), p), Vec3f(p)));
  }

 private:
  static std::vector<LeafIrradiance> particlesOf(const Elements& elements) {
    std::vector<LeafIrradiance> values(elements.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i].indirect = elements.radiometry[i].particle;
    return values;
  }

  SideLocator locator_;
  IrradianceField field_;
};

TEST(CausticError, OfATextureIsAThirdOfAMeshsOnTheSameParticles) {
  constexpr int kPixels = 40, kPoints = 3;  // across; a side of a pixel
  const Scene scene = loadScene({std::string(DELTALUX_SOURCE_DIR) + "/scenes/ring/ring.rad"}).scene;
  const PrimitiveId table = primitivesOf(scene, findObjects(scene, "table").at(0)).at(0);
  std::vector<ProbePoint> points;
  for (int i = 0; i < kPixels * kPixels; ++i)
    for (int k = 0; k < kPoints * kPoints; ++k) {
      const Vec2 part = (Vec2(k % kPoints, k / kPoints) + 0.5) / double(kPoints);
      const Vec2 uv = 0.4 + 0.2 * (Vec2(i % kPixels, i / kPixels) + part) / double(kPixels);
      const SurfacePoint p = pointAt(scene[table].shape, uv);
      points.push_back({p.position, p.normal});
    }
  ReferenceSettings reference;
  reference.samples = 128;
  const std::vector<ProbeResult> truth = ReferenceIntegrator(scene, reference).probe(points);

  Engine engine(scene), onMesh(scene, [] {
    SolveSettings settings;
    settings.causticTextures = false;
    return settings;
  }());
  engine.solve(), onMesh.solve();
  const Solution& s = engine.solution().get();
  ASSERT_EQ(s.particles.hash(), onMesh.solution().get().particles.hash());
  const MeshLight mesh(onMesh.solution().get());
  ProbeSettings precise;
  precise.error = 0.01;
  const std::vector<ProbeResult> shown = probe(engine.solution(), points, precise);
  double ofTexture = 0, ofMesh = 0;
  for (std::size_t i = 0; i < points.size(); i += kPoints * kPoints) {
    double texture = 0, smoothed = 0, noise = 0;
    for (std::size_t k = i; k < i + kPoints * kPoints; ++k) {
      const double E = gray(truth[k].irradiance), error = gray(truth[k].standardError);
      const double caustic = gray(*causticLight(s.caustics, scene, table, 0, true, points[k].position));
      texture += gray(shown[k].irradiance) - E;
      smoothed += gray(shown[k].irradiance) - caustic + mesh.at(table, points[k].position) - E;
      noise += error * error;
    }
    ofTexture += texture * texture - noise, ofMesh += smoothed * smoothed - noise;
  }
  EXPECT_GT(ofTexture, 0);
  EXPECT_LT(std::sqrt(std::max(ofTexture, 0.0) / ofMesh), 1.0 / 3);
  RecordProperty("ratio", std::to_string(std::sqrt(std::max(ofTexture, 0.0) / ofMesh)));
}

}  // namespace
}  // namespace deltalux
