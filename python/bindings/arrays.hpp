#pragma once
// NumPy arrays in and out.
#include <pybind11/numpy.h>

#include <deltalux/math.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/units.hpp>
#include <memory>
#include <utility>
#include <vector>

namespace deltalux::python {

/// Numbers in rows; anything that NumPy makes into them.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
using Indices = pybind11::array_t<std::uint32_t, pybind11::array::c_style | pybind11::array::forcecast>;

/// A (N,3) array as vectors; throws std::invalid_argument (ValueError) that names it: another shape, a number that is
/// not finite.
std::vector<Vec3> vectors(const Numbers&, const char* name);
/// The same of one vector, (3,).
Vec3 vector(const Numbers&, const char* name);
/// A (4,4) array, rows first.
Mat4 matrix(const Numbers&, const char* name);

/// Points and their normals, (N,3) each, in the coordinates of the scene's files, as points of a scene of that origin.
std::vector<ProbePoint> probePoints(const Vec3& origin, const Numbers& points, const Numbers& normals);

/// An array that owns `values`, which it is a view of: no copy.
template <class T, class Element>
pybind11::array_t<T> arrayOf(std::vector<Element>&& values, std::vector<pybind11::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<Element>>(std::move(values));
  const T* data = reinterpret_cast<const T*>(kept->data());
  const pybind11::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<Element>*>(p); });
  kept.release();
  return pybind11::array_t<T>(std::move(shape), data, owner);
}

/// A read-only view of what `owner` keeps alive, `count` records of `stride` bytes, `width` numbers of each.
template <class T>
pybind11::array viewOf(const T* data, std::size_t count, std::size_t width, std::size_t stride,
                       const std::shared_ptr<const void>& owner) {
  using Kept = std::shared_ptr<const void>;
  const pybind11::capsule base(new Kept(owner), [](void* p) { delete static_cast<Kept*>(p); });
  pybind11::array view(
      pybind11::dtype::of<T>(),
      std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(count), static_cast<pybind11::ssize_t>(width)},
      std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(stride), sizeof(T)}, data, base);
  view.attr("setflags")(pybind11::arg("write") = false);
  return view;
}

}  // namespace deltalux::python
