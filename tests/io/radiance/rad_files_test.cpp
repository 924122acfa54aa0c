// Scenes on disk: where included files are looked for, several files as one scene, view files.
#include <gtest/gtest.h>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>

#include <filesystem>
#include <fstream>

namespace deltalux {
namespace {

namespace fs = std::filesystem;

class RadFiles : public ::testing::Test {
 protected:
  RadFiles() {
    const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / ("deltalux_rad_files_" + std::string(info->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "parts");
  }
  ~RadFiles() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(RadFiles, SeveralFilesShareOneNamespaceInOrder) {
  const fs::path materials = write("materials.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n");
  const fs::path ball = write("ball", "grey sphere ball 0 0 4 0 0 0 1\n");
  const ImportedScene imported = loadScene({materials, ball}, {.metresPerUnit = 0.3048});
  EXPECT_EQ(imported.scene.primitives.size(), 1u);
  EXPECT_EQ(imported.scene.metresPerUnit, 0.3048);
  EXPECT_THROW(loadScene({ball, materials}), InputError);
}

TEST_F(RadFiles, IncludesAreFoundBesideTheirReferrerThenBesideTheScene) {
  write("parts/leg.rad", "void plastic near 0 0 5 .5 .5 .5 0 0\nnear sphere leg 0 0 4 0 0 0 1\n");
  write("leg.rad", "void plastic far 0 0 5 .5 .5 .5 0 0\nfar sphere leg 0 0 4 0 0 0 1\n");
  write("top.rad", "void plastic top 0 0 5 .5 .5 .5 0 0\ntop sphere top 0 0 4 0 0 0 1\n");
  write("parts/table.rad", "!xform -n table leg.rad top.rad\n");
  const Scene scene = loadScene({write("room.rad", "!xform -a 2 -t 3 0 0 parts/table.rad\n")}).scene;
  ASSERT_EQ(scene.primitives.size(), 4u);
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "near");
  EXPECT_EQ(scene.materialOf(PrimitiveId(1)).name, "top");
  EXPECT_EQ(scene.objects.back().name, "a1.table.top");
}

TEST_F(RadFiles, IncludesAreFoundFirstWhereTheProgramRuns) {
  const fs::path before = fs::current_path();
  fs::create_directories(folder_ / "project/scene");
  fs::create_directories(folder_ / "project/objects");
  write("project/objects/box.rad", "!genbox grey box 1 1 1\n!xform -t 5 0 0 objects/ball.rad\n");
  write("project/objects/ball.rad", "grey sphere ball 0 0 4 0 0 0 1\n");
  write("project/outline", "0 0\n1 0\n0 1\n");
  write("project/scene/outline", "0 0\n1 0\n1 1\n0 1\n");
  const std::string scene =
      "void plastic grey 0 0 5 .5 .5 .5 0 0\n!xform objects/box.rad\n!genprism grey p outline -l 0 0 1\n";
  const fs::path main = write("project/scene/main.rad", scene);
  EXPECT_THROW(loadScene({main}), InputError);
  fs::current_path(folder_ / "project");
  const std::size_t primitives = loadScene({"scene/main.rad"}).scene.primitives.size();
  const std::size_t absolute = loadScene({main}).scene.primitives.size();
  fs::current_path(before);
  EXPECT_EQ(primitives, 6u + 1 + 5);
  EXPECT_EQ(absolute, primitives);
}

TEST_F(RadFiles, CyclesAreSeenThroughDifferentNames) {
  write("a.rad", "!xform parts/../b.rad\n");
  write("b.rad", "!xform ./a.rad\n");
  EXPECT_THROW(loadScene({folder_ / "a.rad"}), InputError);
}

TEST_F(RadFiles, ErrorsNameTheFileTheyStandIn) {
  write("broken.rad", "\n\nvoid plastic grey 0 0 4 .5 .5 .5 0\n");
  try {
    loadScene({write("scene.rad", "!xform broken.rad\n")});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(fs::path(error.file()).filename(), "broken.rad");
    EXPECT_EQ(error.line(), 3);
  }
  EXPECT_THROW(loadScene({folder_ / "missing.rad"}), InputError);
  EXPECT_THROW(loadScene({folder_}), InputError);
}

TEST_F(RadFiles, TheLastViewOfAFileCounts) {
  const View view =
      loadView(write("two.vf", "# views\nrvu -vp 1 1 1 -vd 1 0 0\nVIEW= -vtv -vp 4 5 6 -vd 0 1 0 -vh 30 -vv 20\n"));
  EXPECT_EQ(view.name, "two");
  EXPECT_EQ(view.position, Vec3(4, 5, 6));
  EXPECT_EQ(view.horizontal, 30);
  EXPECT_THROW(loadView(write("none.vf", "nothing here\n")), InputError);
  EXPECT_THROW(loadView(write("bad.vf", "rvu -vp 1 1\n")), InputError);
}

}  // namespace
}  // namespace deltalux
