#include "session.hpp"

#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "support/temp_folder.hpp"

namespace deltalux::viewer {
namespace {

/// A floor, a box of two faces, and a spot that turns with its object.
constexpr const char* kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red  0 0 5 .6 .1 .1 0 0
void spotlight beam 0 0 7 100 100 100 40 0 0 -1
void light glow 0 0 3 10 10 10
grey polygon floor 0 0 12   0 0 0  4 0 0  4 4 0  0 4 0
red polygon box.top 0 0 12  1 1 1  2 1 1  2 2 1  1 2 1
red polygon box.side 0 0 12 1 1 0  2 1 0  2 1 1  1 1 1
grey sphere ball 0 0 4      3 3 .5 .5
beam ring spot 0 0 8        2 2 3  0 0 -1  0 .1
glow ring panel 0 0 8       1 3 3  0 0 -1  0 .2
)";

Scene roomIn(const test::TempFolder& folder) {
  Scene scene = loadScene({folder.write("room.rad", kRoom)}).scene;
  addAreaLights(scene);
  return scene;
}

Recording startIn(const test::TempFolder& folder) {
  Recording start;
  start.scene = {folder / "room.rad"};
  return start;
}

/// All that light can tell, number for number; `ids`: names of materials count too.
void expectSame(const Scene& a, const Scene& b, bool ids) {
  ASSERT_EQ(a.primitives.size(), b.primitives.size());
  ASSERT_EQ(a.lights.size(), b.lights.size());
  if (ids) {
    ASSERT_EQ(a.materials.size(), b.materials.size());
  }
  for (std::size_t i = 0; i < a.primitives.size(); ++i) {
    const PrimitiveId id(i);
    ASSERT_EQ(area(a[id].shape), area(b[id].shape)) << i;
    if (!(area(a[id].shape) > 0)) continue;  // removed
    for (const Vec2 uv : {Vec2(0.1, 0.2), Vec2(0.9, 0.4), Vec2(0.3, 0.8)}) {
      EXPECT_EQ(pointAt(a[id].shape, uv).position, pointAt(b[id].shape, uv).position) << i;
      EXPECT_EQ(pointAt(a[id].shape, uv).normal, pointAt(b[id].shape, uv).normal) << i;
    }
    const Material &m = a.materialOf(id), &n = b.materialOf(id);
    EXPECT_TRUE(m.surface == n.surface && m.emission == n.emission && m.name == n.name) << i;
    if (ids) {
      EXPECT_EQ(a[id].material, b[id].material) << i;
    }
  }
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].emitter, b.lights[i].emitter) << i;
    EXPECT_EQ(a.lights[i].scale, b.lights[i].scale) << i;
  }
  EXPECT_EQ(a.switchedOff.size(), b.switchedOff.size());
}

/// What playing the record makes of the scene of its files.
Scene replayed(const std::filesystem::path& record) {
  const Recording recording = loadRecording(record);
  Scene scene = loadScene(recording.scene, recording.import).scene;
  addAreaLights(scene);
  EditHistory history;
  for (const EditStep& step : recording.steps) applyStep(scene, history, step);
  return scene;
}

/// A session, and a copy of the scene that does what the engine is told to do.
class ViewerSession : public ::testing::Test {
 protected:
  test::TempFolder folder;
  Scene opened = roomIn(folder);
  Scene follower = opened;
  std::filesystem::path record = folder / "session.json";
  Session session{opened, startIn(folder), record};

  void follow(const Edit& edit) { applyEdit(follower, edit); }
  void follow(const std::vector<Edit>& edits) {
    for (const Edit& edit : edits) follow(edit);
  }
  void drag(const std::string& object, const std::vector<Mat4>& way) {
    session.beginDrag(object);
    for (const Mat4& m : way) follow(session.dragTo(m));
    session.endDrag();
  }
  void check() {
    expectSame(session.scene(), follower, true);
    expectSame(session.scene(), replayed(record), false);
  }
};

Mat4 shift(double x, double y, double z) { return glm::translate(Mat4(1.0), Vec3(x, y, z)); }
Mat4 quarter(const Vec3& about, double angle) {
  return glm::rotate(shift(about.x, about.y, about.z), angle, Vec3(1, 0.3, 0)) * shift(-about.x, -about.y, -about.z);
}

TEST_F(ViewerSession, ADragIsOneStepWhateverItsWay) {
  drag("box", {shift(0.1, 0, 0), shift(0.2, 0.7, 0), quarter({1, 1, 1}, 0.4), shift(0.3, 0.1, 0.2)});
  EXPECT_EQ(session.recording().steps.size(), 1u);
  check();
  Scene direct = opened;
  applyEdit(direct, TransformObject{"box", shift(0.3, 0.1, 0.2)});
  expectSame(session.scene(), direct, true);

  follow(session.undo());
  EXPECT_FALSE(session.canUndo());
  expectSame(session.scene(), opened, true);
  check();
  follow(session.redo());
  expectSame(session.scene(), direct, true);
  check();
}

TEST_F(ViewerSession, ADragThatReturnsIsNone) {
  drag("box", {shift(1, 0, 0), Mat4(1.0)});
  EXPECT_FALSE(session.canUndo());
  EXPECT_TRUE(session.recording().steps.empty());
  expectSame(session.scene(), opened, true);
  check();
}

TEST_F(ViewerSession, ASpotThatIsDraggedTurnsInOneMaterialOfItsOwn) {
  drag("spot", {shift(0, 0.1, 0), quarter({2, 2, 3}, 0.2), quarter({2, 2, 3}, 0.5), shift(0, 0.4, 0),
                quarter({2, 2, 3}, -0.3)});
  EXPECT_EQ(session.scene().materials.size(), opened.materials.size() + 1);
  check();
  follow(session.undo());
  drag("spot", {quarter({2, 2, 3}, 0.7), quarter({2, 2, 3}, 0.9)});
  check();
  follow(session.undo());
  follow(session.redo());
  check();
}

TEST_F(ViewerSession, RefusedActionsChangeNothing) {
  EXPECT_THROW(session.apply(TransformObject{"bax", shift(1, 0, 0)}), InputError);
  EXPECT_THROW(session.beginDrag("bax"), InputError);
  EXPECT_FALSE(session.dragging());
  session.beginDrag("ball");
  follow(session.dragTo(shift(0.5, 0, 0)));
  EXPECT_THROW(session.dragTo(glm::scale(Mat4(1.0), Vec3(1, 2, 1))), InputError);
  session.endDrag();
  Scene direct = opened;
  applyEdit(direct, TransformObject{"ball", shift(0.5, 0, 0)});
  expectSame(session.scene(), direct, true);
  check();
}

TEST_F(ViewerSession, EveryKindOfActionIsUndoneAndReplayed) {
  const std::vector<Edit> edits{TransformObject{"box.top", shift(0, 0, 0.25)},
                                ScaleLight{"spot", 0.3f},
                                ColourLight{"panel", Rgb(0.7f, 0.2f, 0.1f)},
                                SwitchLight{"spot", false},
                                AimLight{"spot", Vec3(1, 0, -2)},
                                MoveLight{"panel", Vec3(0.1, 0, 0)},
                                SetMaterial{"red", Rgb(0.1f, 0.2f, 0.3f), std::nullopt},
                                RemoveObject{"ball"}};
  for (const Edit& edit : edits) follow(session.apply(edit)), check();
  while (session.canUndo()) follow(session.undo());
  expectSame(session.scene(), opened, false);
  check();
  while (session.canRedo()) follow(session.redo());
  check();
}

TEST_F(ViewerSession, StoredStatesAreRestoredExactly) {
  session.store(0, "A", nullptr);
  follow(session.apply(ScaleLight{"panel", 0.5f}));
  drag("box", {shift(0.5, 0, 0), shift(1, 0.5, 0)});
  const Scene b = session.scene();
  session.store(1, "B", nullptr);

  follow(session.restore(0));
  expectSame(session.scene(), opened, true);
  check();
  follow(session.restore(1));
  expectSame(session.scene(), b, true);
  check();

  // Another branch, from which B is no longer on the way back.
  follow(session.restore(0));
  drag("spot", {quarter({2, 2, 3}, 0.3)});
  follow(session.apply(ColourLight{"panel", Rgb(0.1f)}));
  check();
  follow(session.restore(1));
  expectSame(session.scene(), b, false);
  check();
  follow(session.restore(1));  // it is there already
  check();
  follow(session.restore(0));
  expectSame(session.scene(), opened, false);
  check();
}

TEST_F(ViewerSession, CoordinatesAreThoseOfTheFiles) {
  Scene far = opened;
  moveOrigin(far, Vec3(1024, 0, 0));
  Session there(far, startIn(folder), {});
  // Half a turn about the box's own middle, in the files' coordinates.
  const Mat4 turned = glm::rotate(shift(1.5, 1.5, 0), kPi, Vec3(0, 0, 1)) * shift(-1.5, -1.5, 0);
  there.beginDrag("box");
  there.dragTo(turned);
  there.endDrag();
  const PrimitiveId top = primitivesOf(far, findObjects(far, "box.top").front()).front();
  const Vec3 middle = bounds(there.scene()[top].shape).center() + there.scene().origin;
  EXPECT_NEAR(glm::length(middle - Vec3(1.5, 1.5, 1)), 0, 1e-9);
}

TEST_F(ViewerSession, ARecordThatCannotBeWrittenIsToldAndNothingIsLost) {
  Session nowhere(opened, startIn(folder), folder / "missing" / "session.json");
  EXPECT_FALSE(nowhere.recordProblem().empty());
  nowhere.apply(ScaleLight{"panel", 0.5f});
  EXPECT_EQ(nowhere.recording().steps.size(), 1u);
  EXPECT_TRUE(session.recordProblem().empty());
}

/// However often a dimmer moves, it is one step from where it was, and as exact as one edit.
TEST_F(ViewerSession, ADimmerUnderTheHandIsOneStep) {
  for (const float factor : {0.9f, 0.3f, 0.0f, 0.7f}) session.adjust(ScaleLight{"panel", factor});
  EXPECT_TRUE(session.adjusting());
  EXPECT_THROW(session.adjust(ScaleLight{"panle", 0.5f}), InputError);
  session.endAdjust();
  Scene once = opened;
  applyEdit(once, ScaleLight{"panel", 0.7f});
  expectSame(session.scene(), once, true);
  ASSERT_EQ(session.recording().steps.size(), 1u);
  session.undo();
  expectSame(session.scene(), opened, true);
  EXPECT_FALSE(session.canUndo());
  // Whatever comes next lets go of it first.
  session.adjust(ScaleLight{"panel", 0.5f});
  session.apply(RemoveObject{"ball"});
  EXPECT_FALSE(session.adjusting());
  session.undo();
  session.undo();
  expectSame(session.scene(), opened, true);
}

}  // namespace
}  // namespace deltalux::viewer
