// The edit scripts and views beside the scenes name things that are there.
#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/io.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
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

bool hasMaterial(const Scene& scene, const std::string& name) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [&](const Material& m) { return m.name == name; });
}

bool names(const Scene& scene, const nlohmann::json& edit) {
  const std::string op = edit.at("op");
  if (op == "transform" || op == "remove") return !findObjects(scene, edit.at("object").get<std::string>()).empty();
  if (op == "light") return !findLights(scene, edit.at("light").get<std::string>()).empty();
  if (op == "material") return hasMaterial(scene, edit.at("material"));
  return false;
}

TEST_P(SceneScripts, EveryEditNamesSomething) {
  const Scene scene = loadScene({folder() / GetParam().entry}).scene;
  const std::vector<fs::path> scripts = files(".json");
  EXPECT_EQ(scripts.size(), 5u);
  for (const fs::path& script : scripts) {
    std::ifstream in(script);
    const nlohmann::json edits = nlohmann::json::parse(in).at("edits");
    EXPECT_FALSE(edits.empty()) << script;
    for (const nlohmann::json& edit : edits) EXPECT_TRUE(names(scene, edit)) << script << ": " << edit.dump();
  }
}

TEST_P(SceneScripts, ThePapersObjectTakesFourPositions) {
  std::ifstream in(folder() / GetParam().mover);
  EXPECT_EQ(nlohmann::json::parse(in).at("edits").size(), 4u);
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
