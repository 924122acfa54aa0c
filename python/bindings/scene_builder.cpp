// Scenes from data: what deltalux.load_dict hands over, piece by piece, after it has looked at shapes and ranges.
#include <pybind11/stl.h>

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/light.hpp>
#include <deltalux/shape.hpp>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "arrays.hpp"
#include "bind.hpp"
#include "scene.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

using Triple = std::array<double, 3>;

Rgb rgb(const Triple& t) { return Rgb(Vec3(t[0], t[1], t[2])); }
Vec3 vec(const Triple& t) { return {t[0], t[1], t[2]}; }
Vec3 unit(const Triple& t) { return glm::normalize(vec(t)); }

class SceneBuilder {
 public:
  SceneBuilder(double metresPerUnit, double efficacy, const Triple& up) {
    scene_.metresPerUnit = metresPerUnit, scene_.luminousEfficacy = efficacy, scene_.up = unit(up);
  }

  void opaque(const std::string& name, const Triple& reflectance, const Triple& specular, float roughness) {
    addMaterial(name, Opaque{rgb(reflectance), {}, {rgb(specular), roughness}});
  }
  void mirror(const std::string& name, const Triple& reflectance) { addMaterial(name, Mirror{rgb(reflectance)}); }
  void glass(const std::string& name, const Triple& transmissivity, float ior) {
    addMaterial(name, ThinGlass{rgb(transmissivity), ior});
  }
  void dielectric(const std::string& name, const Triple& transmission, float ior) {
    addMaterial(name, Dielectric{rgb(transmission), ior});
  }
  /// Of the material that was added last.
  void emission(const Triple& radiance, bool bothSides) {
    scene_.materials.back().emission = Emission{.radiance = rgb(radiance), .bothSides = bothSides, .spot = {}};
  }

  /// Whether the polygon has an area and a plane; it is left out otherwise.
  bool polygon(const std::string& object, const std::string& material, const Numbers& vertices) {
    return add(object, material, makePolygon(vectors(vertices, "vertices")));
  }
  /// Whether any triangle has an area. Indices are in range.
  bool mesh(const std::string& object, const std::string& material, const Numbers& vertices, const Indices& triangles,
            const std::optional<Numbers>& normals) {
    std::vector<Vec3> smooth;
    if (normals) smooth = vectors(*normals, "normals");
    for (Vec3& n : smooth) n = glm::normalize(n);
    std::vector<std::array<std::uint32_t, 3>> corners;
    const auto rows = triangles.unchecked<2>();
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) corners.push_back({rows(i, 0), rows(i, 1), rows(i, 2)});
    return add(object, material, makeMesh(vectors(vertices, "vertices"), std::move(corners), std::move(smooth)));
  }

  void point(const std::string& name, const Triple& position, const Triple& intensity) {
    addLight(name, PointLight{vec(position), rgb(intensity)});
  }
  /// `inner` and `outer` are half angles [rad].
  void spot(const std::string& name, const Triple& position, const Triple& direction, const Triple& intensity,
            double inner, double outer) {
    addLight(name, SpotLight{vec(position), unit(direction), rgb(intensity), std::cos(inner), std::cos(outer)});
  }
  void lambert(const std::string& name, const Triple& position, const Triple& direction, const Triple& intensity) {
    addLight(name, LambertPointLight{vec(position), unit(direction), rgb(intensity)});
  }
  void measured(const std::string& name, const std::string& file, const Triple& position) {
    addLuminaire(scene_, {file, vec(position)}, &report_.warnings);
    scene_.lights.back().name = name;
  }
  /// `irradiance` across the beam.
  void sun(const std::string& name, const Triple& towards, const Triple& irradiance, double angularRadius) {
    SunLight light{unit(towards), angularRadius, Rgb(0.0f)};
    const double sine = std::sin(angularRadius);
    light.radiance = Rgb(vec(irradiance) / (kPi * sine * sine));  // E = pi L sin^2 of the disc's radius
    addLight(name, light);
  }
  /// The upper half: `radiance` everywhere or, of a CIE sky, at the zenith.
  void sky(const std::string& name, const Triple& radiance, std::optional<int> cie, const Triple& sun) {
    DomeLight dome;
    dome.axis = dome.up = scene_.up;
    dome.scale = rgb(radiance);
    if (cie)
      dome.distribution = CieSky{*cie, 1, 0, unit(sun)};
    else
      dome.distribution = UniformSky{};
    addLight(name, dome);
  }

  void view(const View& view) { scene_.views.push_back(view); }

  SceneHandle finish() {
    addAreaLights(scene_);
    moveOrigin(scene_, fittingOrigin(scene_));
    try {
      validate(scene_);
    } catch (const std::logic_error& error) {
      throw InputError("", 0, error.what());
    }
    return {std::make_shared<const Scene>(std::move(scene_)), std::move(report_)};
  }

 private:
  void addMaterial(const std::string& name, Surface surface) {
    materials_[name] = MaterialId(scene_.materials.size());
    scene_.materials.push_back({.name = name, .surface = std::move(surface), .emission = {}});
  }
  template <class S>
  bool add(const std::string& object, const std::string& material, std::optional<S> shape) {
    if (!shape) return false;
    scene_.primitives.push_back({std::move(*shape), materials_.at(material), internObject(scene_, object, '.')});
    return true;
  }
  template <class Emitter>
  void addLight(const std::string& name, Emitter emitter) {
    scene_.lights.push_back({name, std::move(emitter), Rgb(1.0f)});
  }

  Scene scene_;
  ImportReport report_;
  std::map<std::string, MaterialId> materials_;
};

}  // namespace

void bindSceneBuilder(py::module_& m) {
  py::class_<SceneBuilder>(m, "SceneBuilder")
      .def(py::init<double, double, const Triple&>(), py::arg("metres_per_unit"), py::arg("efficacy"), py::arg("up"))
      .def("opaque", &SceneBuilder::opaque, py::arg("name"), py::arg("reflectance"), py::arg("specular"),
           py::arg("roughness"))
      .def("mirror", &SceneBuilder::mirror, py::arg("name"), py::arg("reflectance"))
      .def("glass", &SceneBuilder::glass, py::arg("name"), py::arg("transmissivity"), py::arg("ior"))
      .def("dielectric", &SceneBuilder::dielectric, py::arg("name"), py::arg("transmission"), py::arg("ior"))
      .def("emission", &SceneBuilder::emission, py::arg("radiance"), py::arg("both_sides"))
      .def("polygon", &SceneBuilder::polygon, py::arg("object"), py::arg("material"), py::arg("vertices"))
      .def("mesh", &SceneBuilder::mesh, py::arg("object"), py::arg("material"), py::arg("vertices"),
           py::arg("triangles"), py::arg("normals"))
      .def("point", &SceneBuilder::point, py::arg("name"), py::arg("position"), py::arg("intensity"))
      .def("spot", &SceneBuilder::spot, py::arg("name"), py::arg("position"), py::arg("direction"),
           py::arg("intensity"), py::arg("inner"), py::arg("outer"))
      .def("lambert", &SceneBuilder::lambert, py::arg("name"), py::arg("position"), py::arg("direction"),
           py::arg("intensity"))
      .def("measured", &SceneBuilder::measured, py::arg("name"), py::arg("file"), py::arg("position"))
      .def("sun", &SceneBuilder::sun, py::arg("name"), py::arg("towards"), py::arg("irradiance"),
           py::arg("angular_radius"))
      .def("sky", &SceneBuilder::sky, py::arg("name"), py::arg("radiance"), py::arg("cie"), py::arg("sun"))
      .def("view", &SceneBuilder::view, py::arg("view"))
      .def("finish", &SceneBuilder::finish);
}

}  // namespace deltalux::python
