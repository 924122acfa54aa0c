// Caustic textures against the reference integrator: the error falls as particles grow; and against the mesh's.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

#include "particles/impact.hpp"
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
  static std::vector<rendering::LeafIrradiance> particlesOf(const hierarchy::Elements& elements) {
    std::vector<rendering::LeafIrradiance> values(elements.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i].indirect = elements.radiometry[i].particle;
    return values;
  }

  hierarchy::SideLocator locator_;
  rendering::IrradianceField field_;
};

/// A square of a surface's parameters, in pixels.
class Pixels {
 public:
  Pixels(const Scene& scene, PrimitiveId primitive, double lower, double width)
      : primitive_(primitive), lower_(lower), width_(width), shape_(scene[primitive].shape) {}

  /// The mean of light(position) over points of each pixel.
  template <class Light>
  std::vector<double> of(const Light& light) const {
    std::vector<double> means;
    for (int i = 0; i < kSide * kSide; ++i) {
      double sum = 0;
      for (int k = 0; k < kPoints * kPoints; ++k) {
        const Vec2 part = (Vec2(k % kPoints, k / kPoints) + 0.5) / double(kPoints);
        const Vec2 uv = lower_ + width_ * (Vec2(i % kSide, i / kSide) + part) / double(kSide);
        sum += light(Vec3(pointAt(shape_, uv).position));
      }
      means.push_back(sum / (kPoints * kPoints));
    }
    return means;
  }

  /// The flux of particles that land on the front of each, over its area.
  std::vector<double> ofParticles(const Solution& s) const {
    std::vector<double> E(kSide * kSide, 0.0);
    const double pixel = area(shape_) * width_ * width_ / static_cast<double>(E.size());
    for (const particles::Impact& impact : particles::impacts(s.particles, s.elements, s.scene)) {
      if (impact.primitive != primitive_ || !impact.front) continue;
      const Vec2 at = double(kSide) / width_ * (Vec2(impact.uv) - lower_);
      if (at.x < 0 || at.y < 0 || at.x >= kSide || at.y >= kSide) continue;
      E[static_cast<std::size_t>(at.y) * kSide + static_cast<std::size_t>(at.x)] += gray(impact.flux) / pixel;
    }
    return E;
  }

 private:
  static constexpr int kSide = 40, kPoints = 3;  // in pixels; in points of a pixel

  PrimitiveId primitive_;
  double lower_, width_;
  const Shape& shape_;
};

double squares(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// What is true is what many times the particles bring to each pixel: paths from the eye find a caustic by chance, and
// one of them outweighs all that either misses. The mesh is refined for the particles as far as they tell.
TEST(CausticError, OfATextureIsBelowHalfOfAMeshsOnTheSameParticles) {
  constexpr std::uint64_t kTimes = 16;
  const Scene scene = loadScene({std::string(DELTALUX_SOURCE_DIR) + "/scenes/ring/ring.rad"}).scene;
  const PrimitiveId table = primitivesOf(scene, findObjects(scene, "table").at(0)).at(0);
  const Pixels pixels(scene, table, 0.4, 0.2);
  SolveSettings onMesh, many;
  onMesh.causticTextures = many.causticTextures = false;
  many.seed = 2;
  Engine engine(scene), meshed(scene, onMesh);
  engine.solve(), meshed.solve();
  const Solution &s = engine.solution().get(), &m = meshed.solution().get();
  ASSERT_EQ(s.particles.hash(), m.particles.hash());
  many.particles = kTimes * s.particles.arrived();
  Engine accurate(scene, many);
  accurate.solve();

  const std::vector<double> truth = pixels.ofParticles(accurate.solution().get());
  const std::vector<double> few = pixels.ofParticles(s);
  const MeshLight mesh(m);
  const auto ofTexture =
      pixels.of([&](const Vec3& p) { return gray(*rendering::causticLight(s.caustics, scene, table, 0, true, p)); });
  const auto ofMesh = pixels.of([&](const Vec3& p) { return mesh.at(table, p); });
  const double noise = squares(few, truth) / (kTimes + 1);
  const double ratio = std::sqrt((squares(ofTexture, truth) - noise) / (squares(ofMesh, truth) - noise));
  EXPECT_GT(ratio, 0);
  EXPECT_LT(ratio, 0.5);
  RecordProperty("ratio", std::to_string(ratio));
}

}  // namespace
}  // namespace deltalux
