// The edit scripts and views beside the scenes can be carried out.
#include <gtest/gtest.h>

#include <deltalux/edit_io.hpp>
#include <filesystem>
#include <string>

#include "support/shared.hpp"

namespace deltalux {
namespace {

namespace fs = std::filesystem;

struct SceneFolder {
  const char* folder;
  const char* entry;
  const char* mover;  // the script that moves the paper's object
};

class SceneScripts : public testing::TestWithParam<SceneFolder> {
 protected:
  fs::path folder() const { return test::sourceFolder() / "scenes" / GetParam().folder; }
  std::vector<fs::path> files(const std::string& extension) const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder()))
      if (entry.path().extension() == extension) found.push_back(entry.path());
    return found;
  }
};

TEST_P(SceneScripts, EveryEditAppliesAndComesBack) {
  const Scene scene = loadScene({folder() / GetParam().entry}).scene;
  std::vector<fs::path> scripts = files(".json");
  std::erase_if(scripts, [](const fs::path& file) { return !file.filename().string().starts_with("edits-"); });
  EXPECT_EQ(scripts.size(), 5u);
  for (const fs::path& script : scripts) {
    const std::vector<EditStep> steps = loadEdits(script);
    EXPECT_FALSE(steps.empty()) << script;
    Scene edited = scene;
    EditHistory history;
    for (const EditStep& step : steps) {
      const SceneChange change = applyStep(edited, history, step).change;
      EXPECT_FALSE(change.moved.empty() && change.lights.empty() && change.materials.empty()) << script;
    }
    EXPECT_NO_THROW(validate(edited)) << script;
    while (history.canUndo()) history.undo(edited);
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      const Box before = bounds(scene.primitives[i].shape), after = bounds(edited.primitives[i].shape);
      ASSERT_TRUE(before.lower == after.lower && before.upper == after.upper) << script << " " << i;
    }
  }
}

TEST_P(SceneScripts, ThePapersObjectTakesFourPositions) {
  EXPECT_EQ(loadEdits(folder() / GetParam().mover).size(), 4u);
}

TEST_P(SceneScripts, ViewsStandInsideTheSceneAndLookSomewhere) {
  const Box box = bounds(loadScene({folder() / GetParam().entry}).scene);
  const std::vector<fs::path> views = files(".vf");
  EXPECT_GE(views.size(), 4u);
  for (const fs::path& file : views) {
    const View view = loadView(file);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(view.position[axis], box.lower[axis] - 30) << file;
      EXPECT_LT(view.position[axis], box.upper[axis] + 30) << file;
    }
    EXPECT_GT(glm::length(view.direction), 0) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(OurTwo, SceneScripts,
                         testing::Values(SceneFolder{"lodge", "morning.rad", "edits-container.json"},
                                         SceneFolder{"street", "day.rad", "edits-car.json"}),
                         [](const auto& instance) { return std::string(instance.param.folder); });

}  // namespace
}  // namespace deltalux
