// Measuring grids.
#include <deltalux/grid.hpp>

#include "arrays.hpp"
#include "bind.hpp"

namespace py = pybind11;

namespace deltalux::python {

namespace {

/// Points (N,3) of the grid of a rectangle, rows along u, without a border.
py::array_t<double> rectangleGrid(const Numbers& corner, const Numbers& u, const Numbers& v, double metresPerUnit,
                                  double spacing) {
  const GridArea area{vector(corner, "corner"), vector(u, "u"), vector(v, "v")};
  const MeasuringGrid grid = gridOf(area, metresPerUnit, {.border = 0, .spacing = spacing});
  std::vector<Vec3> points;
  for (const ProbePoint& p : grid.points) points.push_back(p.position);
  const auto count = static_cast<py::ssize_t>(points.size());
  return arrayOf<double>(std::move(points), {count, 3});
}

}  // namespace

void bindGrid(py::module_& m) {
  m.def("rectangle_grid", &rectangleGrid, py::arg("corner"), py::arg("u"), py::arg("v"), py::arg("metres_per_unit"),
        py::arg("spacing"));
  m.def("grid_spacing", &gridSpacing, py::arg("side"), py::arg("other_side"));
}

}  // namespace deltalux::python
