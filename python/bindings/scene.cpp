// Scenes from files, and what is in a scene.
#include "scene.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <deltalux/error.hpp>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

template <class Things>
py::tuple namesOf(const Things& things) {
  py::list names;
  for (const auto& thing : things) names.append(thing.name);
  return py::tuple(names);
}

py::array_t<double> arrayOfVector(const Vec3& v) { return arrayOf<double>(std::vector<double>{v.x, v.y, v.z}, {3}); }

SceneHandle load(const std::vector<std::string>& files, const ImportSettings& settings,
                 const std::vector<Luminaire>& luminaires) {
  ImportedScene imported = loadScene({files.begin(), files.end()}, settings);
  for (const Luminaire& luminaire : luminaires) addLuminaire(imported.scene, luminaire, &imported.report.warnings);
  return {std::make_shared<const Scene>(std::move(imported.scene)), std::move(imported.report)};
}

}  // namespace

ViewChoice viewChoice(const py::object& view) {
  if (py::isinstance<View>(view)) return view.cast<View>();
  return py::module_::import("os").attr("fsencode")(view).cast<std::string>();
}

View viewOf(const Scene& scene, const ViewChoice& choice) {
  if (const auto* view = std::get_if<View>(&choice)) return inScene(scene, *view);
  const auto& name = std::get<std::string>(choice);
  for (const View& v : scene.views)
    if (v.name == name) return v;
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error)) return inScene(scene, loadView(name));
  std::vector<std::string> existing;
  for (const View& v : scene.views) existing.push_back(v.name);
  throw InputError("", 0, fmt::format("there is no view or view file '{}'", name),
                   existing.empty() ? "the scene has no views of its own; name a .vf file, or make a deltalux.View"
                                    : fmt::format("nearest in the scene: {}; or name a .vf file",
                                                  fmt::join(nearMisses(name, existing), ", ")));
}

void bindScene(py::module_& m) {
  py::class_<SceneHandle>(m, "Scene",
                          "A scene: surfaces, materials, lights, views. Nothing changes it; solve() takes a copy.")
      .def_property_readonly(
          "objects", [](const SceneHandle& s) { return namesOf(s.scene->objects); }, "Names of all objects.")
      .def_property_readonly(
          "materials", [](const SceneHandle& s) { return namesOf(s.scene->materials); }, "Names of all materials.")
      .def_property_readonly(
          "lights", [](const SceneHandle& s) { return namesOf(s.scene->lights); },
          "Names of all lights, surfaces that emit among them; several may share one.")
      .def_property_readonly(
          "views", [](const SceneHandle& s) { return namesOf(s.scene->views); }, "Names of its views.")
      .def_property_readonly(
          "surfaces", [](const SceneHandle& s) { return s.scene->primitives.size(); }, "How many surfaces it has.")
      .def_property_readonly(
          "warnings", [](const SceneHandle& s) { return py::tuple(py::cast(s.report.warnings)); },
          "What its import warned of, one line each.")
      .def_property_readonly(
          "ignored", [](const SceneHandle& s) { return s.report.ignored; }, "What its import ignored: counts by kind.")
      .def_property_readonly(
          "metres_per_unit", [](const SceneHandle& s) { return s.scene->metresPerUnit; }, "Length of its unit [m].")
      .def_property_readonly(
          "efficacy", [](const SceneHandle& s) { return s.scene->luminousEfficacy; },
          "Luminous efficacy by which its light is told [lm/W].")
      .def_property_readonly(
          "up", [](const SceneHandle& s) { return arrayOfVector(s.scene->up); }, "(3,), unit.")
      .def_property_readonly(
          "bounds",
          [](const SceneHandle& s) {
            const Box box = bounds(*s.scene);
            return py::make_tuple(arrayOfVector(box.lower + s.scene->origin),
                                  arrayOfVector(box.upper + s.scene->origin));
          },
          "Least and greatest coordinates of its surfaces: two arrays (3,).");
  m.def(
      "near_misses",
      [](const std::string& name, const std::vector<std::string>& existing) { return nearMisses(name, existing); },
      py::arg("name"), py::arg("existing"));
  m.def(
      "load",
      [](const std::vector<std::string>& files, double metresPerUnit, double efficacy,
         const std::vector<std::pair<std::string, Numbers>>& luminaires) {
        const ImportSettings settings{.luminousEfficacy = efficacy, .metresPerUnit = metresPerUnit};
        std::vector<Luminaire> hung;
        for (const auto& [file, position] : luminaires)
          hung.push_back({file, vector(position, "luminaires: position")});
        const py::gil_scoped_release unlocked;
        return load(files, settings, hung);
      },
      py::arg("files"), py::arg("metres_per_unit"), py::arg("efficacy"), py::arg("luminaires"));
}

}  // namespace deltalux::python
