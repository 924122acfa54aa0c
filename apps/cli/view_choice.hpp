#pragma once
// --view V: a .vf file, or the name of a view or camera of the scene.
#include <deltalux/scene.hpp>
#include <string>

namespace deltalux::cli {

/// The view that `name` means: the scene's view of that name, else the file. Throws InputError with near misses.
View chooseView(const Scene&, const std::string& name);

}  // namespace deltalux::cli
