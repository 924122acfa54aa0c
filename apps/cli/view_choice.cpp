#include "view_choice.hpp"

#include <fmt/format.h>

#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <filesystem>
#include <vector>

namespace deltalux::cli {

namespace {
std::string hintFor(const Scene& scene, const std::string& name) {
  std::vector<std::string> existing;
  for (const View& view : scene.views) existing.push_back(view.name);
  if (existing.empty()) return "the scene has no views of its own; name a .vf file";
  return fmt::format("nearest in the scene: {}; or name a .vf file", fmt::join(nearMisses(name, existing), ", "));
}
}  // namespace

View chooseView(const Scene& scene, const std::string& name) {
  for (const View& view : scene.views)
    if (view.name == name) return view;
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error)) return inScene(scene, loadView(name));
  throw InputError("", 0, fmt::format("there is no view or view file '{}'", name), hintFor(scene, name));
}

}  // namespace deltalux::cli
