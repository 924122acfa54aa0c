#pragma once
#include <pybind11/pybind11.h>

#include <deltalux/io.hpp>
#include <memory>
#include <string>
#include <variant>

namespace deltalux::python {

/// deltalux.Scene: a scene that nothing changes any more, with what its import said.
struct SceneHandle {
  std::shared_ptr<const Scene> scene;
  ImportReport report;
};

/// A View, in the coordinates of the scene's files; or the name of a view of the scene, else of a .vf file.
using ViewChoice = std::variant<View, std::string>;
/// Of a View, or a name (str or os.PathLike).
ViewChoice viewChoice(const pybind11::object&);
/// What it means, in the scene's own coordinates. Throws InputError with near misses.
View viewOf(const Scene&, const ViewChoice&);

}  // namespace deltalux::python
