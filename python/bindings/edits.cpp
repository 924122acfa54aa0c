// Edits as values, and lists of them.
#include "edits.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "arrays.hpp"
#include "bind.hpp"
#include "scene.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

Rgb rgb(const Numbers& array, const char* name) { return Rgb(vector(array, name)); }

Mat4 translation(const Numbers& offset) { return glm::translate(Mat4(1.0), vector(offset, "translate")); }

/// As edits files mean it.
Mat4 rotation(const Numbers& axis, double degrees, const Numbers& about) {
  const Vec3 a = vector(axis, "rotate: axis"), centre = vector(about, "rotate: about");
  if (!(glm::length(a) > 0)) throw std::invalid_argument("rotate: the axis has no length");
  if (!std::isfinite(degrees)) throw std::invalid_argument("rotate: the angle is not finite");
  return glm::translate(glm::rotate(glm::translate(Mat4(1.0), centre), glm::radians(degrees), glm::normalize(a)),
                        -centre);
}

AddObject addition(const std::string& object, const std::string& file, const SceneHandle& part, const Mat4& placed) {
  return {object, file, part.scene, placed};
}

/// As edits files mean it.
Daylighting daylighting(const std::string& sky, const std::string& when, const Place& place, double north,
                        double ground) {
  const auto model = parseSkyModel(sky);
  const auto time = parseCivilTime(when);
  if (!model) throw std::invalid_argument("sky: is none of 'cie:TYPE', 'cie:TYPE,LUX', 'perez:DIRECT_NORMAL,DIFFUSE'");
  if (!time) throw std::invalid_argument("when: is no time as '2026-06-21T09:00+02:00', of 1900 to 2100");
  if (!(std::abs(place.latitude) <= 90 && std::abs(place.longitude) <= 180))
    throw std::invalid_argument("where: is no latitude and longitude in degrees");
  if (!std::isfinite(north)) throw std::invalid_argument("north: is not finite");
  return {*model, *time, place, north, ground};
}

/// A light as edits see it: its scale when it is on, and whether it is.
struct LightState {
  std::string name;
  std::tuple<float, float, float> rgb;
  bool on;
};

std::vector<LightState> lightsOf(const EditList& list, const std::string& name) {
  const Scene& scene = list.scene();
  std::vector<LightState> states;
  for (const LightId light : findLights(scene, name)) {
    const auto off = std::ranges::find(scene.switchedOff, light, &SwitchedOff::light);
    const bool on = off == scene.switchedOff.end();
    const Rgb scale = on ? scene[light].scale : off->scale;
    states.push_back({scene[light].name, {scale.r, scale.g, scale.b}, on});
  }
  return states;
}

/// What of a material can be set, as far as it has it.
struct MaterialState {
  std::optional<std::tuple<float, float, float>> reflectance;
  std::optional<float> roughness;
};

struct StateOf {
  MaterialState operator()(const Opaque& s) const {
    const bool glossOnly = isBlack(s.diffuse) && !isBlack(s.specular.reflectance);
    return {triple(glossOnly ? s.specular.reflectance : s.diffuse), roughness(s.specular)};
  }
  MaterialState operator()(const Mirror& s) const { return {triple(s.reflectance), {}}; }
  MaterialState operator()(const Trans& s) const {
    return {triple(s.diffuseReflectance), roughness(isBlack(s.reflection.reflectance) ? s.transmission : s.reflection)};
  }
  MaterialState operator()(const ThinGlass&) const { return {}; }
  MaterialState operator()(const Dielectric&) const { return {}; }

  static std::tuple<float, float, float> triple(const Rgb& c) { return {c.r, c.g, c.b}; }
  static std::optional<float> roughness(const SpecularLobe& lobe) {
    return isBlack(lobe.reflectance) ? std::nullopt : std::optional(lobe.roughness);
  }
};

/// Of the first material of that name; nullopt: there is none.
std::optional<MaterialState> materialOf(const EditList& list, const std::string& name) {
  const std::vector<Material>& all = list.scene().materials;
  const auto found = std::ranges::find(all, name, &Material::name);
  return found == all.end() ? std::nullopt : std::optional(std::visit(StateOf{}, found->surface));
}

}  // namespace

void bindEdits(py::module_& m) {
  py::class_<LightState>(m, "LightState")
      .def_readonly("name", &LightState::name)
      .def_readonly("rgb", &LightState::rgb)
      .def_readonly("on", &LightState::on);
  py::class_<MaterialState>(m, "MaterialState")
      .def_readonly("reflectance", &MaterialState::reflectance)
      .def_readonly("roughness", &MaterialState::roughness);
  py::class_<EditList>(m, "EditList")
      .def("__len__", [](const EditList& l) { return l.edits().size(); })
      .def(
          "translate",
          [](EditList& l, const std::string& object, const Numbers& offset) {
            l.take(TransformObject{object, translation(offset)});
          },
          py::arg("object"), py::arg("offset"))
      .def(
          "rotate",
          [](EditList& l, const std::string& object, const Numbers& axis, double degrees, const Numbers& about) {
            l.take(TransformObject{object, rotation(axis, degrees, about)});
          },
          py::arg("object"), py::arg("axis"), py::arg("degrees"), py::arg("about"))
      .def(
          "transform",
          [](EditList& l, const std::string& object, const Numbers& map) {
            l.take(TransformObject{object, matrix(map, "matrix")});
          },
          py::arg("object"), py::arg("matrix"))
      .def(
          "add",
          [](EditList& l, const std::string& object, const SceneHandle& part, const Numbers& placed,
             const std::string& file) { l.take(addition(object, file, part, matrix(placed, "matrix"))); },
          py::arg("object"), py::arg("part"), py::arg("matrix"), py::arg("file"))
      .def(
          "remove", [](EditList& l, const std::string& object) { l.take(RemoveObject{object}); }, py::arg("object"))
      .def(
          "dim",
          [](EditList& l, const std::string& light, float factor) {
            l.take(ScaleLight{light, factor});
          },
          py::arg("light"), py::arg("factor"))
      .def(
          "colour",
          [](EditList& l, const std::string& light, const Numbers& colour) {
            l.take(ColourLight{light, rgb(colour, "rgb")});
          },
          py::arg("light"), py::arg("rgb"))
      .def(
          "switch",
          [](EditList& l, const std::string& light, bool on) {
            l.take(SwitchLight{light, on});
          },
          py::arg("light"), py::arg("on"))
      .def(
          "aim",
          [](EditList& l, const std::string& light, const Numbers& direction) {
            l.take(AimLight{light, vector(direction, "direction")});
          },
          py::arg("light"), py::arg("direction"))
      .def(
          "move_light",
          [](EditList& l, const std::string& light, const Numbers& offset) {
            l.take(MoveLight{light, vector(offset, "offset")});
          },
          py::arg("light"), py::arg("offset"))
      .def(
          "set_material",
          [](EditList& l, const std::string& material, const std::optional<Numbers>& reflectance,
             std::optional<float> roughness) {
            SetMaterial edit{material, {}, roughness};
            if (reflectance) edit.reflectance = rgb(*reflectance, "reflectance");
            l.take(edit);
          },
          py::arg("material"), py::arg("reflectance"), py::arg("roughness"))
      .def(
          "sky",
          [](EditList& l, const std::string& sky, const std::string& when, double latitude, double longitude,
             double north, double ground) {
            l.take(SetDaylight{daylighting(sky, when, {latitude, longitude}, north, ground)});
          },
          py::arg("sky"), py::arg("when"), py::arg("latitude"), py::arg("longitude"), py::arg("north"),
          py::arg("ground"))
      .def("lights", &lightsOf, py::arg("name"))
      .def("material", &materialOf, py::arg("name"));
}

}  // namespace deltalux::python
