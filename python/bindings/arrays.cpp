#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace deltalux::python {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw std::invalid_argument(message); }

std::string shapeOf(const Numbers& array) {
  std::string text;
  for (pybind11::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

}  // namespace

std::vector<Vec3> vectors(const Numbers& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    refuse(std::string(name) + ": an array of shape (N, 3) is wanted, this one has " + shapeOf(array));
  const auto rows = array.unchecked<2>();
  std::vector<Vec3> result(static_cast<std::size_t>(rows.shape(0)));
  for (pybind11::ssize_t i = 0; i < rows.shape(0); ++i) {
    Vec3& v = result[static_cast<std::size_t>(i)] = {rows(i, 0), rows(i, 1), rows(i, 2)};
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      refuse(std::string(name) + "[" + std::to_string(i) + "] is not finite");
  }
  return result;
}

Vec3 vector(const Numbers& array, const char* name) {
  if (array.ndim() != 1 || array.shape(0) != 3)
    refuse(std::string(name) + ": three numbers are wanted, this array has shape " + shapeOf(array));
  const Vec3 v{array.at(0), array.at(1), array.at(2)};
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) refuse(std::string(name) + " is not finite");
  return v;
}

Mat4 matrix(const Numbers& array, const char* name) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    refuse(std::string(name) + ": a matrix of shape (4, 4) is wanted, this array has " + shapeOf(array));
  Mat4 m;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      m[column][row] = array.at(row, column);
      if (!std::isfinite(m[column][row])) refuse(std::string(name) + " is not finite");
    }
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    refuse(std::string(name) + " is no affine map: its last row is not 0 0 0 1");
  if (!(std::abs(glm::determinant(m)) > 0)) refuse(std::string(name) + " flattens what it maps: its determinant is 0");
  return m;
}

std::vector<ProbePoint> probePoints(const Vec3& origin, const Numbers& points, const Numbers& normals) {
  const std::vector<Vec3> p = vectors(points, "points"), n = vectors(normals, "normals");
  if (p.size() != n.size())
    refuse("points and normals: " + std::to_string(p.size()) + " and " + std::to_string(n.size()) +
           " rows; each point has its normal");
  std::vector<ProbePoint> result;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double largest = std::max({std::abs(n[i].x), std::abs(n[i].y), std::abs(n[i].z)});
    if (!(largest > 0)) refuse("normals[" + std::to_string(i) + "] has no direction");
    result.push_back({p[i] - origin, glm::normalize(n[i] / largest)});  // as points files are read
  }
  return result;
}

}  // namespace deltalux::python
