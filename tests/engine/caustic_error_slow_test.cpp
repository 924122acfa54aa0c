// What probes read from caustic textures against the reference integrator: the error falls as particles grow.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>

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

}  // namespace
}  // namespace deltalux
