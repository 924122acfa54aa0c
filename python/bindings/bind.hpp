#pragma once
// What the module deltalux._core holds, one file each. Docstrings here are short: the package's own functions, which
// people call, stand in python/deltalux/ and say shapes, units and errors.
#include <pybind11/pybind11.h>

namespace deltalux::python {

void bindErrors();
void bindScene(pybind11::module_&);
void bindSceneBuilder(pybind11::module_&);
void bindImages(pybind11::module_&);
void bindEdits(pybind11::module_&);
void bindMesh(pybind11::module_&);
void bindSolution(pybind11::module_&);
void bindGlare(pybind11::module_&);
void bindGrid(pybind11::module_&);

}  // namespace deltalux::python
