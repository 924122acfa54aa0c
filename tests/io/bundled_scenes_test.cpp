// The bundled scenes of known answer and the nasty set: they load completely, and are what their heads say.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <map>

#include "support/shared.hpp"

namespace deltalux {
namespace {

std::filesystem::path bundled(const std::string& name) { return test::sourceFolder() / "scenes" / name; }

/// Loads a scene that must not lose anything on import.
Scene load(const std::string& name) {
  ImportedScene imported = loadScene({bundled(name)});
  EXPECT_TRUE(imported.report.ignored.empty()) << name;
  EXPECT_TRUE(imported.report.warnings.empty()) << name << ": " << imported.report.warnings.front();
  EXPECT_NO_THROW(validate(imported.scene)) << name;
  return std::move(imported.scene);
}

/// The primitives of the object called `name`; the test fails when there is none.
std::vector<Primitive> parts(const Scene& scene, const std::string& name) {
  std::vector<Primitive> found;
  for (const ObjectId object : findObjects(scene, name))
    for (const PrimitiveId primitive : primitivesOf(scene, object)) found.push_back(scene[primitive]);
  EXPECT_FALSE(found.empty()) << name;
  return found;
}

double areaOf(const Scene& scene, const std::string& name) {
  double sum = 0;
  for (const Primitive& primitive : parts(scene, name)) sum += area(primitive.shape);
  return sum;
}

Rgb rho(const Scene& scene, const std::string& object) {
  return diffuseReflectance(scene[parts(scene, object).at(0).material], true);
}

void expectNear(const Vec3& a, const Vec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
}

class NastyScene : public testing::TestWithParam<const char*> {};

TEST_P(NastyScene, LoadsCompletely) {
  const Scene scene = load(std::string("nasty/") + GetParam());
  EXPECT_FALSE(scene.primitives.empty());
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_TRUE(std::isfinite(bounds(scene).diagonal()));
  for (const Primitive& primitive : scene.primitives) EXPECT_GT(area(primitive.shape), 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, NastyScene,
                         testing::Values("slivers.rad", "coplanar.rad", "touching.rad", "sealed.rad",
                                         "mirror_corridor.rad", "thin.rad", "nested_glass.rad", "outlines.rad",
                                         "far_away.rad", "scales.rad"),
                         [](const auto& scene) {
                           const std::string name = scene.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(BundledScenes, FacesWithoutAreaAreCountedAndLeftOut) {
  const ImportedScene imported = loadScene({bundled("nasty/zero_area.obj")});
  EXPECT_EQ(imported.report.ignored, (std::map<std::string, std::size_t>{{"faces without area", 3}}));
  EXPECT_NO_THROW(validate(imported.scene));
  EXPECT_NEAR(areaOf(imported.scene, "floor"), 1.0, 1e-9);
  EXPECT_EQ(imported.scene.lights.size(), 1u);
}

TEST(BundledScenes, CornellIsThePublishedBox) {
  const Scene scene = load("cornell/cornell.rad");
  EXPECT_EQ(scene.primitives.size(), 17u);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(rho(scene, "left.lower"), Rgb(0.630f, 0.065f, 0.050f));
  EXPECT_EQ(rho(scene, "right"), Rgb(0.140f, 0.450f, 0.091f));
  EXPECT_EQ(rho(scene, "tall_block"), Rgb(0.725f, 0.710f, 0.680f));
  const auto lamp = parts(scene, "lamp").at(0);
  EXPECT_EQ(scene[lamp.material].emission->radiance, Rgb(17, 12, 4));
  expectNear(std::get<Polygon>(lamp.shape).normal, {0, -1, 0});
  EXPECT_NEAR(areaOf(scene, "lamp"), 0.130 * 0.105, 1e-9);
  expectNear(std::get<Polygon>(parts(scene, "short_block.top").at(0).shape).vertices[0], {0.130, 0.165, 0.065});
  expectNear(std::get<Polygon>(parts(scene, "tall_block.top").at(0).shape).vertices[3], {0.472, 0.330, 0.406});
  EXPECT_EQ(parts(scene, "short_block").size(), 5u);
  expectNear(bounds(scene).upper, {0.556, 0.5488, 0.5592});
}

TEST(BundledScenes, CornellCausticHasAMirrorAndABall) {
  const Scene scene = load("cornell-caustic/cornell-caustic.rad");
  EXPECT_EQ(scene.primitives.size(), 18u);
  for (const Primitive& face : parts(scene, "tall_block")) {
    EXPECT_EQ(std::get<Mirror>(scene[face.material].surface).reflectance, Rgb(0.9f));
    const auto& polygon = std::get<Polygon>(face.shape);
    EXPECT_GT(glm::dot(polygon.normal, polygon.vertices[0] - Vec3(0.3685, 0.165, 0.351)), 0) << "mirrors face outwards";
  }
  EXPECT_EQ(std::get<Dielectric>(scene[parts(scene, "ball").at(0).material].surface).ior, 1.5f);
}

TEST(BundledScenes, ViewsBelongToTheirScenes) {
  for (const char* name : {"cornell/cornell.vf", "cornell-caustic/cornell-caustic.vf"}) {
    const View view = loadView(bundled(name));
    expectNear(view.position, {0.278, 0.273, -0.8});
    EXPECT_NEAR(view.horizontal, 2 * std::atan(12.5 / 35) * 180 / kPi, 1e-4);
  }
  for (const char* name : {"ring/ring.vf", "ring/top.vf"}) EXPECT_NO_THROW(loadView(bundled(name)));
}

TEST(BundledScenes, FurnaceIsClosedFacesInwardsAndEmitsOne) {
  const Scene scene = load("furnace/furnace.gltf");
  double total = 0;
  for (const Primitive& primitive : scene.primitives) {
    total += area(primitive.shape);
    const Material& material = scene[primitive.material];
    EXPECT_EQ(diffuseReflectance(material, true), Rgb(0.5f));
    EXPECT_FALSE(isSpecular(material));
    ASSERT_TRUE(material.emission);
    EXPECT_NEAR(material.emission->radiance.g, 1.0f, 1e-6f);
    for (const double u : {0.1, 0.35, 0.6, 0.9}) {
      const SurfacePoint p = samplePoint(primitive.shape, {u, 0.3});
      EXPECT_GT(glm::dot(p.normal, Vec3(0.5) - p.position), 0) << "front faces inwards";
    }
  }
  EXPECT_NEAR(total, 6.0, 1e-6);
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_TRUE(bounds(scene).contains(scene.views[0].position));
}

TEST(BundledScenes, RingIsBrassUnderASpotOverItsEdge) {
  const Scene scene = load("ring/ring.rad");
  const auto inside = std::get<Cylinder>(parts(scene, "ring.inside").at(0).shape);
  EXPECT_TRUE(inside.inward);
  EXPECT_EQ(parts(scene, "ring").size(), 3u);
  const auto& brass = std::get<Opaque>(scene[parts(scene, "ring").at(0).material].surface);
  EXPECT_EQ(brass.specular.roughness, 0.0f);
  EXPECT_GT(brass.specular.reflectance.r, brass.specular.reflectance.b);  // a metal's reflection is coloured
  const Primitive lamp = parts(scene, "lamp").at(0);
  EXPECT_TRUE(scene[lamp.material].emission->spot);
  EXPECT_NEAR(glm::length(glm::dvec2(std::get<Ring>(lamp.shape).center)), inside.radius, 1e-12);
}

TEST(BundledScenes, PlatesAreUnitSquaresThatFaceEachOther) {
  for (const char* name : {"plates/parallel.rad", "plates/perpendicular.rad"}) {
    const Scene scene = load(name);
    EXPECT_EQ(scene.primitives.size(), 2u);
    EXPECT_NEAR(areaOf(scene, "sender"), 1.0, 1e-12);
    EXPECT_NEAR(areaOf(scene, "receiver"), 1.0, 1e-12);
    const auto sender = std::get<Polygon>(parts(scene, "sender").at(0).shape);
    const auto receiver = std::get<Polygon>(parts(scene, "receiver").at(0).shape);
    const Vec3 between = pointAt(receiver, {0.5, 0.5}).position - pointAt(sender, {0.5, 0.5}).position;
    EXPECT_GT(glm::dot(sender.normal, between), 0);
    EXPECT_LT(glm::dot(receiver.normal, between), 0);
  }
}

TEST(BundledScenes, OutlinesHaveTheirAreas) {
  const Scene scene = load("nasty/outlines.rad");
  const std::map<std::string, double> areas{
      {"frame", 0.75}, {"star", 0.281232}, {"u", 7.0 / 9}, {"comb", 0.64}, {"beaded", 1}};
  for (const auto& [name, expected] : areas) EXPECT_NEAR(areaOf(scene, name), expected, 1e-6) << name;
}

TEST(BundledScenes, SliversTileTheUnitSquare) {
  const Scene scene = load("nasty/slivers.rad");
  EXPECT_NEAR(areaOf(scene, "strip") + areaOf(scene, "fan"), 1.0, 1e-9);
}

}  // namespace
}  // namespace deltalux
