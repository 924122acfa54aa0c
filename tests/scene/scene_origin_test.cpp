// Scenes far from the origin of their coordinates have an origin of their own, and describe the same.
#include <gtest/gtest.h>

#include <deltalux/edit.hpp>
#include <deltalux/io.hpp>
#include <deltalux/points.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "support/rooms.hpp"
#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using namespace test;

const Vec3 kSite(5200000, -4100000, 1200);
constexpr const char* kRoom =
    "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light glow 0 0 3 5 5 5\n"
    "!genbox grey room 4 4 3 -i | xform -t {x} {y} {z}\n!xform -t {x} {y} {z} lamp.rad\n"
    "!genbox grey table 1.1 .9 .7 | xform -t 1.3 .4 0 -t {x} {y} {z}\n";
constexpr const char* kLamp =
    "glow polygon lamp 0 0 12 1 1 2.9 1 2 2.9 2 2 2.9 2 1 2.9\n"
    "grey sphere ball 0 0 4 1 3 1 .3\ngrey ring ring 0 0 8 3 3 1 0 0 1 0 .2\n"
    "grey cone cone 0 0 8 3 1 0 3 1 1 .2 .1\ngrey tube tube 0 0 7 2 3 0 2 3 1 .1\n";

std::string replaced(std::string text, const std::string& what, double by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;) text.replace(at, what.size(), std::to_string(by));
  return text;
}

Scene roomAt(const Vec3& place, const std::string& more = "") {
  const TempFolder folder;
  folder.write("lamp.rad", kLamp);
  const std::string text = replaced(replaced(replaced(kRoom, "{x}", place.x), "{y}", place.y), "{z}", place.z);
  return loadScene({folder.write("room.rad", text + more)}).scene;
}

/// The room near the origin, in the coordinates of a scene of the room at the site.
Mat4 nearTo(const Scene& far) { return glm::translate(Mat4(1.0), kSite - far.origin); }

void expectSameShapes(const Scene& far, const Scene& near, double tolerance) {
  ASSERT_EQ(far.primitives.size(), near.primitives.size());
  for (std::size_t i = 0; i < far.primitives.size(); ++i) {
    const Shape &a = far.primitives[i].shape, b = *transformed(near.primitives[i].shape, nearTo(far));
    ASSERT_EQ(a.index(), b.index());
    if (!(area(a) > 0) && !(area(b) > 0)) continue;
    EXPECT_NEAR(area(a), area(b), tolerance) << i;
    for (const Vec2 uv : {Vec2(0.1, 0.3), Vec2(0.6, 0.2), Vec2(0.8, 0.9)}) {
      EXPECT_LT(glm::distance(pointAt(a, uv).position, pointAt(b, uv).position), tolerance) << i;
      EXPECT_LT(glm::distance(parameterAt(a, pointAt(b, uv).position), uv), tolerance) << i;
    }
  }
}

TEST(SceneOrigin, OrdinaryScenesHaveNone) {
  for (const char* name : {"cornell/cornell.rad", "lodge/morning.rad", "nasty/scales.rad", "nasty/zero_area.obj",
                           "furnace/furnace.gltf", "plates/parallel.rad", "ring/ring.rad"})
    EXPECT_EQ(loadScene({bundledScene(name)}).scene.origin, Vec3(0)) << name;
  EXPECT_EQ(roomAt(Vec3(0)).origin, Vec3(0));
  EXPECT_EQ(roomAt(Vec3(30, -20, 5)).origin, Vec3(0)) << "no farther away than a few times its size";
  EXPECT_EQ(fittingOrigin(Scene{}), Vec3(0));
}

TEST(SceneOrigin, FarScenesAreNearTheirOwn) {
  const Scene near = roomAt(Vec3(0)), far = roomAt(kSite);
  EXPECT_LT(glm::length(far.origin - kSite), 10);
  EXPECT_LT(bounds(far).diagonal(), bounds(near).diagonal() + 1e-6);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(far.origin[axis], std::round(far.origin[axis]));
  EXPECT_NO_THROW(validate(far));
  expectSameShapes(far, near, 1e-8);
  Scene again = far;
  moveOrigin(again, fittingOrigin(again));
  EXPECT_EQ(again.origin, far.origin) << "once is enough";
}

TEST(SceneOrigin, WhatIsLeftAtZeroDoesNotKeepItThere) {
  const Scene far = roomAt(kSite, "grey polygon arrow 0 0 9 0 0 0 1 0 0 0 1 0\n");
  EXPECT_LT(glm::length(far.origin - kSite), 10);
}

TEST(SceneOrigin, LightsViewsAndPointsFollow) {
  Scene scene = roomAt(kSite);
  const TempFolder folder;
  const auto ies =
      folder.write("spot.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n10 10\n");
  addLuminaire(scene, {ies, kSite + Vec3(1, 2, 2.5)});
  EXPECT_EQ(std::get<PhotometricLight>(scene.lights.back().emitter).position + scene.origin, kSite + Vec3(1, 2, 2.5));
  const auto file = folder.write("v.vf", "rvu -vtv -vp 5200001 -4099999 1201.5 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 60\n");
  const View view = inScene(scene, loadView(file));
  EXPECT_EQ(view.position + scene.origin, kSite + Vec3(1, 1, 1.5));
  const PointTable table = parsePoints("x,y,z,nx,ny,nz\n5200000.125,-4100000,1200.5,0,0,1\n", "p.csv");
  EXPECT_EQ(pointsIn(scene, table).at(0).position + scene.origin, kSite + Vec3(0.125, 0, 0.5));
  EXPECT_EQ(table.rows[0][0], "5200000.125");
}

TEST(SceneOrigin, EditsSpeakOfTheFilesCoordinates) {
  Scene near = roomAt(Vec3(0)), far = roomAt(kSite);
  const Mat4 turn = glm::rotate(glm::translate(Mat4(1.0), Vec3(1.5, 1, 0)), 0.4, Vec3(0, 0, 1));
  const Mat4 toSite = glm::translate(Mat4(1.0), kSite), fromSite = glm::translate(Mat4(1.0), -kSite);
  applyEdit(near, TransformObject{"table", turn});
  applyEdit(far, TransformObject{"table", toSite * turn * fromSite});
  expectSameShapes(far, near, 1e-7);
  applyEdit(near, MoveLight{"lamp", {0.25, 0, 0}});
  applyEdit(far, MoveLight{"lamp", {0.25, 0, 0}});
  expectSameShapes(far, near, 1e-7);
  applyEdit(far, TransformObject{"table", toSite * glm::inverse(turn) * fromSite});
  EXPECT_EQ(bounds(far.primitives[8].shape).upper, bounds(roomAt(kSite).primitives[8].shape).upper)
      << "there and back is where it was, to the bit";
  EXPECT_NO_THROW(validate(far));
}

TEST(SceneOrigin, WhatIsAddedLandsWhereItsFileSays) {
  const auto part = [](const Vec3& place) { return std::make_shared<const Scene>(roomAt(place)); };
  const Mat4 toSite = glm::translate(Mat4(1.0), kSite);
  Scene near = roomAt(Vec3(0)), byMatrix = roomAt(kSite), byFile = roomAt(kSite);
  applyEdit(near, AddObject{"more", "more.rad", part(Vec3(10, 0, 0)), Mat4(1.0)});
  applyEdit(byMatrix, AddObject{"more", "more.rad", part(Vec3(10, 0, 0)), toSite});
  applyEdit(byFile, AddObject{"more", "more.rad", part(kSite + Vec3(10, 0, 0)), Mat4(1.0)});
  EXPECT_NO_THROW(validate(byMatrix));
  for (const Scene* far : {&byMatrix, &byFile}) {
    expectSameShapes(*far, near, 1e-7);
    EXPECT_LT(glm::length(bounds(*far).upper + far->origin - kSite - bounds(near).upper), 1e-7);
  }
}

TEST(SceneOrigin, WhatIsAddedIsAsBrightInLumens) {
  Scene scene = roomAt(Vec3(0));
  scene.luminousEfficacy = 683;
  Scene part = roomAt(Vec3(10, 0, 0));
  part.lights.push_back({"spot", PointLight{Vec3(11, 1, 1), Rgb(683.0f)}, Rgb(1.0f)});
  applyEdit(scene, AddObject{"more", "more.rad", std::make_shared<const Scene>(part), Mat4(1.0)});
  const Light& spot = scene[findLights(scene, "more.spot").at(0)];
  EXPECT_NEAR(std::get<PointLight>(spot.emitter).intensity.g, 179, 1e-4);
  const auto& lamp = std::get<AreaLight>(scene[findLights(scene, "more.lamp").at(0)].emitter);
  EXPECT_NEAR(scene.materialOf(lamp.primitive).emission->radiance.g * 683, 5 * 179, 1e-3);
}

}  // namespace
}  // namespace deltalux
