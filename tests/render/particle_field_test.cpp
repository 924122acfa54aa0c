// Light that a mirror throws on a wall has edges: close to them, inside and out, particles tell where the light is.
#include "render/particle_field.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace rendering;

namespace {

/// The sun, low in the east, is thrown by a mirror on the ground onto a wall in the west: z in [1,2], y in [0,1].
struct Patch {
  static constexpr double kE = 0.9;  // of the sun's irradiance there
  Engine engine{scene(), settings()};
  Patch() { engine.solve(); }

  static Scene scene() {
    Scene scene;
    const MaterialId wall = test::addMaterial(scene, "wall", test::lambert(0.5f));
    test::addPolygon(scene, wall, {{-1, -1, 0}, {-1, 3, 0}, {-1, 3, 3}, {-1, -1, 3}});
    test::addPolygon(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
                     {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    SunLight sun;
    sun.direction = glm::normalize(Vec3(1, 0, 1));
    sun.angularRadius = 0.001;
    sun.radiance = Rgb(static_cast<float>(std::sqrt(2.0) / solidAngle(sun)));
    test::addLight(scene, sun);
    return scene;
  }
  static SolveSettings settings() {
    SolveSettings s;
    s.particles = 40000;
    return s;
  }
};

TEST(ParticleField, KeepsEdges) {
  const Patch patch;
  const ParticleField field(patch.engine.solution().get());
  const auto at = [&](double y, double z) {
    return field.at(PrimitiveId(0), true, {-1, y, z}, {1, 0, 0}).g / Patch::kE;
  };
  EXPECT_NEAR(at(0.5, 1.5), 1.0, 0.1);
  for (const double d : {0.03, 0.06, 0.1}) {
    for (const double along : {0.2, 0.5, 0.8}) {
      EXPECT_NEAR(at(along, 1 + d), 1.0, 0.2) << d;
      EXPECT_NEAR(at(1 - d, 1 + along), 1.0, 0.2) << d;
      EXPECT_NEAR(at(along, 1 - d), 0.0, 0.03) << d;
      EXPECT_NEAR(at(1 + d, 1 + along), 0.0, 0.03) << d;
    }
  }
}

}  // namespace
}  // namespace deltalux
