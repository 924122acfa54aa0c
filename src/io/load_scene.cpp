#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/solution_file.hpp>

#include "io/gltf.hpp"
#include "io/lower_case.hpp"
#include "io/mitsuba.hpp"
#include "io/obj.hpp"
#include "io/pbrt.hpp"
#include "io/radiance.hpp"

namespace deltalux::io {

namespace fs = std::filesystem;

namespace {

std::string extensionOf(const fs::path& file) { return lowerCase(file.extension().string()); }

bool isOtherFormat(const fs::path& file) {
  const std::string extension = extensionOf(file);
  return extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".xml" ||
         extension == ".pbrt";
}

ImportedScene readFiles(const std::vector<fs::path>& files, const ImportSettings& settings) {
  const auto other = std::find_if(files.begin(), files.end(), isOtherFormat);
  if (other == files.end()) return loadRadiance(files, settings);
  if (files.size() > 1) {
    throw InputError(other->string(), 0, "cannot be joined with other files into one scene",
                     "only several Radiance files make one scene");
  }
  const std::string extension = extensionOf(*other);
  if (extension == ".xml") return loadMitsuba(*other, settings);
  if (extension == ".pbrt") return loadPbrt(*other, settings);
  return extension == ".obj" ? loadObj(*other, settings) : loadGltf(*other, settings);
}

}  // namespace

}  // namespace deltalux::io

namespace deltalux {

ImportedScene loadScene(const std::vector<std::filesystem::path>& files, const ImportSettings& settings) {
  if (files.empty()) throw InputError("", 0, "no scene is given", "name a .rad, .gltf, .glb, .obj, .xml or .pbrt file");
  if (!(settings.metresPerUnit > 0) || !(settings.luminousEfficacy > 0)) {
    throw InputError(files[0].string(), 0, "metres per unit and luminous efficacy must be greater than zero");
  }
  const auto solution = std::find_if(files.begin(), files.end(), isSolutionFile);
  if (solution != files.end())
    throw InputError(solution->string(), 0, "is a solution, and a scene is asked for",
                     "name the scene it was made from");
  ImportedScene imported = io::readFiles(files, settings);
  moveOrigin(imported.scene, fittingOrigin(imported.scene));
  return imported;
}

}  // namespace deltalux
