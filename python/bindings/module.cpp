#include "bind.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace deltalux::python;
  m.doc() = "The compiled part of deltalux; use the package.";
  m.attr("__version__") = DELTALUX_VERSION;
  bindErrors();
  bindImages(m);
  bindScene(m);
  bindSceneBuilder(m);
  bindEdits(m);
  bindMesh(m);
  bindSolution(m);
  bindGlare(m);
  bindGrid(m);
}
