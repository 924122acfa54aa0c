// Views and pictures.
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bind.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

using Pixels = py::array_t<float, py::array::c_style | py::array::forcecast>;

View makeView(const Numbers& position, const Numbers& direction, const Numbers& up, double horizontal, double vertical,
              bool parallel, std::string name) {
  View view;
  view.name = std::move(name);
  view.kind = parallel ? View::Kind::Parallel : View::Kind::Perspective;
  view.position = vector(position, "position"), view.direction = vector(direction, "direction");
  view.up = vector(up, "up"), view.horizontal = horizontal, view.vertical = vertical;
  if (!(glm::length(glm::cross(view.direction, view.up)) > 0))
    throw std::invalid_argument("a view's direction and up have lengths, and are not along each other");
  const double most = parallel ? kInfinity : 180;
  for (const double extent : {horizontal, vertical})
    if (!(extent > 0 && extent < most))
      throw std::invalid_argument("a view's horizontal and vertical are above 0; as angles, below 180 degrees");
  return view;
}

Image imageOf(const Pixels& pixels, double efficacy) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 3 || pixels.size() == 0)
    throw std::invalid_argument("radiance: an array of shape (height, width, 3) is wanted");
  Image image;
  image.height = static_cast<int>(pixels.shape(0)), image.width = static_cast<int>(pixels.shape(1));
  image.luminousEfficacy = efficacy;
  const auto p = pixels.unchecked<3>();
  image.pixels.reserve(static_cast<std::size_t>(image.width) * image.height);
  for (py::ssize_t y = 0; y < p.shape(0); ++y)
    for (py::ssize_t x = 0; x < p.shape(1); ++x) image.pixels.emplace_back(p(y, x, 0), p(y, x, 1), p(y, x, 2));
  return image;
}

void save(const std::string& path, const Image& image, std::optional<double> ev) {
  const std::optional<ImageFormat> format = imageFormatOf(path);
  if (!format) throw std::invalid_argument(path + ": a picture's name ends in .exr, .hdr or .png");
  if (ev && format != ImageFormat::Png) throw std::invalid_argument("ev: only a .png is exposed");
  ToneMapping mapping;
  if (format == ImageFormat::Png) mapping.ev = ev ? *ev : automaticEv(image);
  saveImage(path, image, mapping);
}

}  // namespace

void bindImages(py::module_& m) {
  py::class_<View>(m, "View",
                   "A camera, in the coordinates of the scene's files. `horizontal` and `vertical` are full angles in\n"
                   "degrees or, where `parallel`, extents in scene units.")
      .def(py::init(&makeView), py::arg("position"), py::arg("direction"), py::arg("up") = py::make_tuple(0, 0, 1),
           py::arg("horizontal") = 45.0, py::arg("vertical") = 45.0, py::arg("parallel") = false, py::arg("name") = "")
      .def_readonly("name", &View::name)
      .def_readonly("horizontal", &View::horizontal)
      .def_readonly("vertical", &View::vertical)
      .def_property_readonly("parallel", [](const View& v) { return v.kind == View::Kind::Parallel; })
      .def_property_readonly("position",
                             [](const View& v) { return py::make_tuple(v.position.x, v.position.y, v.position.z); })
      .def_property_readonly("direction",
                             [](const View& v) { return py::make_tuple(v.direction.x, v.direction.y, v.direction.z); })
      .def_property_readonly("up", [](const View& v) { return py::make_tuple(v.up.x, v.up.y, v.up.z); });
  m.def(
      "load_view", [](const std::string& file) { return loadView(file); }, py::arg("file"));
  m.def(
      "save_image",
      [](const std::string& path, const Pixels& radiance, std::optional<double> ev, double efficacy) {
        const Image image = imageOf(radiance, efficacy);
        const py::gil_scoped_release unlocked;
        save(path, image, ev);
      },
      py::arg("path"), py::arg("radiance"), py::arg("ev"), py::arg("efficacy"));
  m.def(
      "load_image",
      [](const std::string& file) {
        Image image;
        {
          const py::gil_scoped_release unlocked;
          image = loadImage(file);
        }
        return arrayOf<float>(std::move(image.pixels), {image.height, image.width, 3});
      },
      py::arg("file"));
}

}  // namespace deltalux::python
