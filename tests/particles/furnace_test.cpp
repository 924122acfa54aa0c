// In a closed room whose walls all send and reflect alike, light is the same everywhere whatever mirrors and glass
// stand in it: what they take from a wall's view they give back from elsewhere.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "hierarchy/build.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr float kRho = 0.5f;
constexpr double kExact = kPi / (1 - kRho);

Scene furnace() {
  Scene scene;
  const MaterialId wall = test::addMaterial(scene, "wall", test::lambert(kRho), Emission{Rgb(1.0f), false, {}});
  test::addBox(scene, wall, {0, 0, 0}, {1, 1.5, 0.8}, true);
  return scene;
}

double meanIrradiance(const Solution& s, std::size_t walls) {
  double power = 0, area = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    if (t.kind != hierarchy::ElementKind::Patch || t.emitter || t.blocker || t.childCount > 0 || !t.front) continue;
    if (s.elements.domain[i].primitive.index() >= walls) continue;
    const hierarchy::ElementLight& l = s.elements.radiometry[i];
    power += s.elements.geometry[i].area * (l.direct + l.indirect + l.particle).g;
    area += s.elements.geometry[i].area;
  }
  return power / area;
}

/// What lands by particles of lights and of walls that send what they would.
double depositedFlux(const Scene& scene) {
  const auto tracer = tracing::makeEmbreeTracer(scene);
  const Particles p = traceParticles(scene, *tracer, {300000, 1});
  EXPECT_NO_THROW(validate(p, scene));
  hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.isReceivingLeaf(hierarchy::ElementId(i)))
      elements.radiometry[i].B = Rgb(static_cast<float>(kRho * kExact));
  double deposited = 0;
  for (const Impact& i : impacts(p, elements, scene)) deposited += i.flux.g;
  return deposited;
}

/// `taken`: area of a convex block that gives back all that reaches it. What lands by particles is then known: the
/// radiosity of the walls times that area.
void expectFurnace(Scene scene, double taken) {
  addAreaLights(scene);
  EXPECT_NEAR(depositedFlux(scene) / (kExact * taken), 1.0, 0.01);  // chance alone makes 0.3 %
  SolveSettings settings;
  settings.error = 0.02, settings.particles = 300000;
  Engine engine(std::move(scene), settings);
  engine.solve();
  EXPECT_NEAR(meanIrradiance(engine.solution().get(), 6) / kExact, 1.0, 0.01);
}

double boxArea(const Vec3& size) { return 2 * (size.x * size.y + size.y * size.z + size.z * size.x); }

TEST(ParticleFurnace, MirrorBlock) {
  Scene scene = furnace();
  test::addBox(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(1.0f)}), {0.2, 0.3, 0.1}, {0.5, 0.6, 0.5}, false);
  expectFurnace(std::move(scene), boxArea({0.3, 0.3, 0.4}));
}

TEST(ParticleFurnace, GlassBlock) {
  Scene scene = furnace();
  test::addBox(scene, test::addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), {0.2, 0.3, 0.1}, {0.5, 0.6, 0.5},
               false);
  expectFurnace(std::move(scene), boxArea({0.3, 0.3, 0.4}));
}

TEST(ParticleFurnace, GlassBall) {
  Scene scene = furnace();
  test::addShape(scene, test::addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{0.5, 0.7, 0.4}, 0.3});
  expectFurnace(std::move(scene), 4 * kPi * 0.09);
}

TEST(ParticleFurnace, MirrorBlockAndGlassBall) {
  Scene scene = furnace();
  test::addBox(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(1.0f)}), {0.2, 0.3, 0.1}, {0.5, 0.6, 0.5}, false);
  test::addShape(scene, test::addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{0.6, 1.1, 0.3}, 0.2});
  SolveSettings settings;
  settings.error = 0.02, settings.particles = 300000, settings.method = SolveMethod::Paper;
  Engine engine(std::move(scene), settings);
  engine.solve();
  EXPECT_NEAR(meanIrradiance(engine.solution().get(), 6) / kExact, 1.0, 0.01);
}

/// A pane passes what it does not reflect.
TEST(ParticleFurnace, Pane) {
  Scene scene = furnace();
  test::addPolygon(scene, test::addMaterial(scene, "pane", ThinGlass{Rgb(1.0f), 1.52f}),
                   {{0.2, 0.7, 0.1}, {0.8, 0.7, 0.1}, {0.8, 0.9, 0.7}, {0.2, 0.9, 0.7}});
  SolveSettings settings;
  settings.error = 0.02, settings.particles = 300000, settings.method = SolveMethod::Paper;
  Engine engine(std::move(scene), settings);
  engine.solve();
  EXPECT_NEAR(meanIrradiance(engine.solution().get(), 6) / kExact, 1.0, 0.01);
}

/// What is glossy shines on itself: more comes back to a wall than all walls could send it over one of them.
TEST(ParticleFurnace, BrassWalls) {
  constexpr float diffuse = 0.2f, specular = 0.6f;
  Scene scene;
  const MaterialId brass = test::addMaterial(scene, "brass", Opaque{Rgb(diffuse), {}, {Rgb(specular), 0.0f, {}}},
                                             Emission{Rgb(1.0f), false, {}});
  test::addBox(scene, brass, {0, 0, 0}, {1, 1.5, 0.8}, true);
  SolveSettings settings;
  settings.error = 0.02, settings.particles = 300000, settings.method = SolveMethod::Paper;
  Engine engine(std::move(scene), settings);
  engine.solve();
  EXPECT_NEAR(meanIrradiance(engine.solution().get(), 6) / (kPi / (1 - diffuse - specular)), 1.0, 0.01);
}

}  // namespace
}  // namespace deltalux
