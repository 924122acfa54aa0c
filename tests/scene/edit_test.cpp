// Edits change what they say and nothing else, and come back exactly.
#include <gtest/gtest.h>

#include <deltalux/edit.hpp>
#include <deltalux/error.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/random.hpp"
#include "support/solution_scenes.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A table with two legs and a lamp on it, a ball, and lights of every kind.
Scene room() {
  Scene scene = oneOfEverything();
  const auto add = [&](const char* name, Shape shape, MaterialId material) {
    scene.primitives.push_back({std::move(shape), material, internObject(scene, name, '.')});
    return PrimitiveId(scene.primitives.size() - 1);
  };
  const MaterialId wood = addMaterial(scene, "wood", lambert(0.4f));
  const MaterialId glow = addMaterial(scene, "glow", lambert(0), Emission{Rgb(5.0f), false, SpotCone{1.0, {0, 0, -2}}});
  add("table.top", *makePolygon({{1, 1, 0.7}, {2, 1, 0.7}, {2, 1.5, 0.7}, {1, 1.4, 0.7}}), wood);
  add("table.leg.0", Cylinder{{1.1, 1.1, 0}, {1.1, 1.1, 0.7}, 0.03, false}, wood);
  add("table.leg.1", Cylinder{{1.9, 1.1, 0}, {1.9, 1.1, 0.7}, 0.03, false}, wood);
  add("table.lamp", *makePolygon({{1.4, 1.2, 0.9}, {1.4, 1.3, 0.9}, {1.5, 1.3, 0.9}, {1.5, 1.2, 0.9}}), glow);
  add("ball", Sphere{{0.3, 0.3, 0.1}, 0.1, false}, wood);
  addAreaLights(scene);
  scene.lights.push_back({"table.candle", SpotLight{{1.2, 1.2, 0.9}, {0, 0, -1}, Rgb(1.0f), 0.9, 0.8}, Rgb(1.0f)});
  validate(scene);
  return scene;
}

PrimitiveId partOf(const Scene& scene, const std::string& object, std::size_t i = 0) {
  return primitivesOf(scene, findObjects(scene, object).at(0)).at(i);
}
const Light& lightNamed(const Scene& scene, const std::string& name) { return scene[findLights(scene, name).at(0)]; }

/// Everything that transport sees of two scenes is bitwise the same.
void expectSame(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.primitives.size(), b.primitives.size());
  for (std::size_t i = 0; i < a.primitives.size(); ++i) {
    const Primitive &p = a.primitives[i], &q = b.primitives[i];
    EXPECT_EQ(p.shape.index(), q.shape.index()) << i;
    EXPECT_EQ(area(p.shape), area(q.shape)) << i;
    EXPECT_EQ(bounds(p.shape).lower, bounds(q.shape).lower) << i;
    EXPECT_EQ(bounds(p.shape).upper, bounds(q.shape).upper) << i;
    if (area(p.shape) > 0)
      for (const Vec2 uv : {Vec2(0.1, 0.3), Vec2(0.7, 0.9)}) {
        EXPECT_EQ(pointAt(p.shape, uv).position, pointAt(q.shape, uv).position) << i;
        EXPECT_EQ(pointAt(p.shape, uv).normal, pointAt(q.shape, uv).normal) << i;
      }
    const auto &m = a[p.material], &n = b[q.material];
    EXPECT_EQ(diffuseReflectance(m, true), diffuseReflectance(n, true));
    if (m.emission && m.emission->spot) {
      EXPECT_EQ(m.emission->spot->direction, n.emission->spot->direction);
    }
  }
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].scale, b.lights[i].scale) << i;
    EXPECT_EQ(a.lights[i].emitter.index(), b.lights[i].emitter.index()) << i;
    std::visit(
        [&](const auto& e) {
          const auto& f = std::get<std::decay_t<decltype(e)>>(b.lights[i].emitter);
          if constexpr (requires { e.position; }) {
            EXPECT_EQ(e.position, f.position) << i;
          }
          if constexpr (requires { e.direction; }) {
            EXPECT_EQ(e.direction, f.direction) << i;
          }
          if constexpr (requires { e.primitive; }) {
            EXPECT_EQ(e.primitive, f.primitive) << i;
          }
          if constexpr (requires { e.frame; }) {
            EXPECT_EQ(e.frame, f.frame) << i;
          }
        },
        a.lights[i].emitter);
  }
  EXPECT_EQ(a.switchedOff.size(), b.switchedOff.size());
}

Mat4 moved(const Vec3& by) { return glm::translate(Mat4(1.0), by); }
Mat4 turned(double degrees, const Vec3& axis, const Vec3& about) {
  return glm::translate(glm::rotate(glm::translate(Mat4(1.0), about), glm::radians(degrees), glm::normalize(axis)),
                        -about);
}

TEST(Edit, TransformMovesTheObjectAndAllBelowIt) {
  Scene scene = room();
  const Scene before = scene;
  const AppliedEdit applied = applyEdit(scene, TransformObject{"table", moved({0, 0, 1})});
  EXPECT_NO_THROW(validate(scene));
  ASSERT_EQ(applied.change.moved.size(), 4u);
  for (const SceneChange::Moved& m : applied.change.moved) {
    EXPECT_EQ(m.before.lower, bounds(before[m.primitive].shape).lower);
    EXPECT_EQ(m.after.lower, bounds(scene[m.primitive].shape).lower);
    EXPECT_NEAR(m.after.lower.z - m.before.lower.z, 1, 1e-12);
  }
  EXPECT_EQ(std::get<Sphere>(scene[partOf(scene, "ball")].shape).center, Vec3(0.3, 0.3, 0.1));
  EXPECT_EQ(std::get<SpotLight>(lightNamed(scene, "table.candle").emitter).position, Vec3(1.2, 1.2, 1.9));
  const std::vector<LightId> lamps{findLights(scene, "table.lamp").at(0), findLights(scene, "table.candle").at(0)};
  EXPECT_EQ(applied.change.lights, lamps);
  EXPECT_TRUE(applied.change.materials.empty());
  applyEdit(scene, applied.inverse);
  expectSame(scene, before);
}

TEST(Edit, TurningALampTurnsItsConeAlone) {
  Scene scene = room();
  const Scene before = scene;
  const auto applied = applyEdit(scene, TransformObject{"table.lamp", turned(90, {1, 0, 0}, {1.4, 1.2, 0.9})});
  const Material& glow = scene.materialOf(partOf(scene, "table.lamp"));
  EXPECT_NEAR(glm::distance(glow.emission->spot->direction, Vec3(0, 2, 0)), 0, 1e-12);
  EXPECT_EQ(scene[before[partOf(before, "table.lamp")].material].emission->spot->direction, Vec3(0, 0, -2))
      << "others that share the material keep theirs";
  applyEdit(scene, applied.inverse);
  expectSame(scene, before);
}

TEST(Edit, TheOppositeEditReturnsToTheBit) {
  Scene scene = room();
  const Scene before = scene;
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 by(rng.uniform() - 0.5, rng.uniform() - 0.5, 3 * rng.uniform());
    applyEdit(scene, TransformObject{"table", moved(by)});
    applyEdit(scene, TransformObject{"table", moved(-by)});
    const double degrees = 360 * rng.uniform();
    applyEdit(scene, TransformObject{"ball", turned(degrees, {1, 2, 3}, by)});
    applyEdit(scene, TransformObject{"ball", turned(-degrees, {1, 2, 3}, by)});
  }
  for (const PrimitiveId p : {partOf(scene, "table.top"), partOf(scene, "table.leg.1"), partOf(scene, "ball")}) {
    EXPECT_EQ(bounds(scene[p].shape).lower, bounds(before[p].shape).lower);
    EXPECT_EQ(pointAt(scene[p].shape, {0.3, 0.2}).position, pointAt(before[p].shape, {0.3, 0.2}).position);
  }
  EXPECT_NEAR(
      glm::distance(std::get<SpotLight>(lightNamed(scene, "table.candle").emitter).position, Vec3(1.2, 1.2, 0.9)), 0,
      1e-12);
}

TEST(Edit, TheShapeDependsOnThePlaceNotOnTheWay) {
  Scene inSteps = room(), atOnce = room();
  for (int i = 0; i < 4; ++i) applyEdit(inSteps, TransformObject{"table", moved({0.25, 0, 0.5})});
  applyEdit(atOnce, TransformObject{"table", moved({1, 0, 2})});
  expectSame(inSteps, atOnce);
}

TEST(Edit, RemovedThingsHaveNoExtentAndComeBack) {
  Scene scene = room();
  const Scene before = scene;
  const PrimitiveId top = partOf(scene, "table.top");
  const auto applied = applyEdit(scene, RemoveObject{"table"});
  EXPECT_NO_THROW(validate(scene));
  EXPECT_EQ(area(scene[top].shape), 0);
  EXPECT_EQ(applied.change.moved.size(), 4u);
  EXPECT_TRUE(applied.change.moved[0].after.empty());
  EXPECT_FALSE(applied.change.moved[0].before.empty());
  EXPECT_EQ(applied.change.lights.size(), 2u);
  addAreaLights(scene);
  EXPECT_EQ(scene.lights.size(), before.lights.size()) << "no light for a lamp that is gone";
  EXPECT_THROW(applyEdit(scene, RemoveObject{"table"}), InputError);
  EXPECT_THROW(applyEdit(scene, TransformObject{"table", moved({1, 0, 0})}), InputError);
  EXPECT_THROW(applyEdit(scene, ScaleLight{"table.candle", 2}), InputError);
  const auto back = applyEdit(scene, applied.inverse);
  expectSame(scene, before);
  EXPECT_TRUE(back.change.moved[0].before.empty());
  applyEdit(scene, back.inverse);
  EXPECT_EQ(area(scene[top].shape), 0);
}

TEST(Edit, AddBringsSurfacesMaterialsAndLampsButNoSky) {
  Scene scene = room();
  const Scene before = scene, part = room();
  const AddObject add{"guest", "guest.rad", std::make_shared<const Scene>(part), moved({0, 0, 5})};
  const auto applied = applyEdit(scene, add);
  EXPECT_NO_THROW(validate(scene));
  EXPECT_EQ(scene.primitives.size(), 2 * before.primitives.size());
  EXPECT_EQ(applied.change.moved.size(), before.primitives.size());
  EXPECT_TRUE(applied.change.moved[0].before.empty());
  const auto ball = std::get<Sphere>(scene[partOf(scene, "guest.ball")].shape);
  EXPECT_EQ(ball.center, Vec3(0.3, 0.3, 5.1));
  EXPECT_EQ(findLights(scene, "guest.table").size(), 2u);
  std::size_t skies = 0;
  for (const Light& l : scene.lights)
    skies += std::holds_alternative<SunLight>(l.emitter) || std::holds_alternative<DomeLight>(l.emitter);
  EXPECT_EQ(skies, 6u);
  for (std::size_t i = before.lights.size(); i < scene.lights.size(); ++i)
    if (const auto* area = std::get_if<AreaLight>(&scene.lights[i].emitter)) {
      EXPECT_GE(area->primitive.index(), before.primitives.size());
    }
  EXPECT_THROW(applyEdit(scene, add), InputError) << "the name is taken";
  EXPECT_NO_THROW(applyEdit(scene, TransformObject{"guest.table", moved({0, 1, 0})}));
  const Scene there = scene;
  const auto gone = applyEdit(scene, RemoveObject{"guest"});
  for (std::size_t i = 0; i < before.primitives.size(); ++i) {
    EXPECT_EQ(bounds(scene.primitives[i].shape).lower, bounds(before.primitives[i].shape).lower);
  }
  EXPECT_NO_THROW(validate(scene));
  applyEdit(scene, gone.inverse);
  expectSame(scene, there);
}

TEST(Edit, LightsAreDimmedColouredSwitchedAndRemember) {
  Scene scene = room();
  const Scene before = scene;
  const auto scale = [&] { return lightNamed(scene, "table.candle").scale; };
  const auto dimmed = applyEdit(scene, ScaleLight{"table.candle", 0.5f});
  EXPECT_EQ(scale(), Rgb(0.5f));
  EXPECT_TRUE(dimmed.change.moved.empty());
  EXPECT_EQ(dimmed.change.lights, findLights(scene, "table.candle"));
  applyEdit(scene, SwitchLight{"table.candle", false});
  EXPECT_EQ(scale(), Rgb(0.0f));
  EXPECT_NO_THROW(validate(scene));
  applyEdit(scene, ScaleLight{"table.candle", 0.5f});
  EXPECT_EQ(scale(), Rgb(0.0f)) << "dimmed while it is off";
  applyEdit(scene, SwitchLight{"table.candle", false});
  applyEdit(scene, SwitchLight{"table.candle", true});
  EXPECT_EQ(scale(), Rgb(0.25f));
  applyEdit(scene, ColourLight{"table.candle", {1, 0.5f, 0}});
  EXPECT_EQ(scale(), Rgb(1, 0.5f, 0));
  applyEdit(scene, ScaleLight{"table", 2});
  EXPECT_EQ(scale(), Rgb(2, 1, 0));
  EXPECT_EQ(lightNamed(scene, "table.lamp").scale, Rgb(2.0f)) << "all lights below the name";
}

TEST(Edit, LightsAreAimedAndMoved) {
  Scene scene = room();
  const Scene before = scene;
  EditHistory history;
  for (const Light& light : before.lights) {
    const bool dome = std::holds_alternative<DomeLight>(light.emitter),
               point = std::holds_alternative<PointLight>(light.emitter);
    const bool infinite = dome || std::holds_alternative<SunLight>(light.emitter);
    if (dome || point)
      EXPECT_THROW(history.apply(scene, AimLight{light.name, {1, 0, 0}}), InputError) << light.name;
    else
      history.apply(scene, AimLight{light.name, {0, 3, 0}});
    if (infinite)
      EXPECT_THROW(history.apply(scene, MoveLight{light.name, {1, 0, 0}}), InputError) << light.name;
    else
      history.apply(scene, MoveLight{light.name, {0, 0.25, 0}});
    EXPECT_NO_THROW(validate(scene));
  }
  EXPECT_EQ(std::get<SpotLight>(lightNamed(scene, "table.candle").emitter).direction, Vec3(0, 1, 0));
  EXPECT_EQ(std::get<SpotLight>(lightNamed(scene, "table.candle").emitter).position, Vec3(1.2, 1.45, 0.9));
  EXPECT_NEAR(bounds(scene[partOf(scene, "table.lamp")].shape).lower.y, 1.45, 1e-12);
  EXPECT_NEAR(scene.materialOf(partOf(scene, "table.lamp")).emission->spot->direction.y, 2, 1e-12);
  std::size_t measured = 0;
  for (const Light& light : scene.lights) {
    if (const auto* l = std::get_if<PhotometricLight>(&light.emitter)) {
      EXPECT_NEAR(glm::distance(-l->frame[2], Vec3(0, 1, 0)), 0, 1e-12);
      EXPECT_NEAR(glm::determinant(l->frame), 1, 1e-12);
      ++measured;
    }
    if (const auto* sun = std::get_if<SunLight>(&light.emitter)) {
      EXPECT_EQ(sun->direction, Vec3(0, -1, 0));
    }
  }
  EXPECT_EQ(measured, 2u);
  while (history.canUndo()) history.undo(scene);
  expectSame(scene, before);
}

TEST(Edit, MaterialsReflectOtherwise) {
  Scene scene = room();
  const auto applied = applyEdit(scene, SetMaterial{"wood", Rgb(0.1f, 0.2f, 0.3f), {}});
  EXPECT_EQ(diffuseReflectance(scene.materialOf(partOf(scene, "ball")), true), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(applied.change.materials.size(), 1u);
  EXPECT_TRUE(applied.change.moved.empty());
  applyEdit(scene, SetMaterial{"brass", {}, 0.3f});
  const auto brass = [&] { return std::get<Opaque>(scene.materials[1].surface); };
  EXPECT_EQ(brass().specular.roughness, 0.3f);
  EXPECT_THROW(applyEdit(scene, SetMaterial{"brass", Rgb(0.9f), {}}), InputError) << "with its lobe more than all";
  EXPECT_THROW(applyEdit(scene, SetMaterial{"pane", Rgb(0.5f), {}}), InputError);
  EXPECT_THROW(applyEdit(scene, SetMaterial{"wood", {}, 0.2f}), InputError);
  EXPECT_THROW(applyEdit(scene, SetMaterial{"wood", Rgb(1.2f), {}}), InputError);
  EXPECT_THROW(applyEdit(scene, SetMaterial{"wood", {}, {}}), InputError);
  applyEdit(scene, SetMaterial{"mirror", Rgb(0.5f), {}});
  EXPECT_EQ(std::get<Mirror>(scene.materials[5].surface).reflectance, Rgb(0.5f));
  applyEdit(scene, applied.inverse);
  EXPECT_EQ(diffuseReflectance(scene.materialOf(partOf(scene, "ball")), true), Rgb(0.4f));
}

TEST(Edit, CoverageStaysWithWhatIsPainted) {
  Scene scene = room();
  Material& wood = scene.materials[scene[partOf(scene, "ball")].material.index()];
  wood.coverage = 0.25f;
  applyEdit(scene, SetMaterial{wood.name, Rgb(0.8f), {}});
  EXPECT_EQ(diffuseReflectance(scene.materialOf(partOf(scene, "ball")), true), Rgb(0.2f));
  EXPECT_EQ(straightTransmittance(scene.materialOf(partOf(scene, "ball")), 1.0), Rgb(0.75f));
}

TEST(Edit, UnknownNamesAreRefusedWithNearMisses) {
  Scene scene = room();
  const Scene before = scene;
  const auto hint = [&](const Edit& edit) {
    try {
      validateEdit(scene, edit);
    } catch (const InputError& error) {
      EXPECT_NE(error.message().find("there is no"), std::string::npos);
      return error.hint();
    }
    return std::string("was taken");
  };
  EXPECT_NE(hint(TransformObject{"tabel", Mat4(1.0)}).find("table"), std::string::npos);
  EXPECT_NE(hint(RemoveObject{"bal"}).find("ball"), std::string::npos);
  EXPECT_NE(hint(ScaleLight{"table.candel", 1}).find("table.candle"), std::string::npos);
  EXPECT_NE(hint(SetMaterial{"wod", Rgb(0.5f), {}}).find("wood"), std::string::npos);
  expectSame(scene, before);
}

TEST(Edit, WhatCannotBeDoneChangesNothing) {
  Scene scene = room();
  const Scene before = scene;
  Mat4 shear(1.0);
  shear[1][0] = 0.5;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Edit> wrong{TransformObject{"table", shear},
                                TransformObject{"ball", glm::scale(Mat4(1.0), Vec3(1, 2, 1))},
                                TransformObject{"ball", moved({nan, 0, 0})},
                                ScaleLight{"table.lamp", -1.0f},
                                ColourLight{"table.lamp", {1, -1, 0}},
                                AimLight{"table.lamp", Vec3(0)},
                                MoveLight{"table.lamp", {nan, 0, 0}},
                                AddObject{"guest", "", nullptr, Mat4(1.0)}};
  for (const Edit& edit : wrong) {
    EXPECT_THROW(validateEdit(scene, edit), InputError) << editOperation(edit) << " " << editSubject(edit);
    EXPECT_THROW(applyEdit(scene, edit), InputError);
  }
  expectSame(scene, before);
  EXPECT_TRUE(scene.placements.empty());
  EXPECT_NO_THROW(applyEdit(scene, TransformObject{"table.top", shear})) << "a polygon may be sheared";
}

TEST(Edit, UndoAndRedoWalkTheSameStates) {
  Scene scene = room();
  std::vector<Scene> states{scene};
  EditHistory history;
  const std::vector<Edit> edits{TransformObject{"table", moved({0.5, 0, 0})},
                                RemoveObject{"ball"},
                                ScaleLight{"table", 0.0f},
                                TransformObject{"table", turned(30, {0, 0, 1}, {1.5, 1, 0})},
                                SwitchLight{"table.candle", false},
                                SetMaterial{"wood", Rgb(0.9f), {}},
                                AddObject{"guest", "", std::make_shared<const Scene>(room()), moved({0, 0, 9})}};
  for (const Edit& edit : edits) history.apply(scene, edit), states.push_back(scene);
  states.pop_back();
  const Scene last = scene;
  history.undo(scene);  // of the addition: its things stay, without extent
  for (std::size_t i = 0; i < states.back().primitives.size(); ++i)
    EXPECT_EQ(area(scene.primitives[i].shape), area(states.back().primitives[i].shape));
  for (std::size_t i = states.back().primitives.size(); i < scene.primitives.size(); ++i)
    EXPECT_EQ(area(scene.primitives[i].shape), 0);
  EXPECT_NO_THROW(validate(scene));
  history.redo(scene);
  expectSame(scene, last);
  while (history.canUndo()) history.undo(scene);
  for (std::size_t i = 0; i < states[0].primitives.size(); ++i)
    EXPECT_EQ(bounds(scene.primitives[i].shape).lower, bounds(states[0].primitives[i].shape).lower);
  while (history.canRedo()) history.redo(scene);
  expectSame(scene, last);
  history.undo(scene);
  history.apply(scene, ScaleLight{"table.lamp", 2});
  EXPECT_FALSE(history.canRedo());
}

}  // namespace
}  // namespace deltalux
