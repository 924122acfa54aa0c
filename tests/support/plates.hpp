#pragma once
// The bundled pairs of black plates, one of which shines: their form factors have closed forms.
#include <deltalux/io.hpp>
#include <utility>

#include "support/run_cli.hpp"
#include "support/solved.hpp"

namespace deltalux::test {

struct Plates {
  const char* name;
  double factor;  // from the emitter to the receiver
};
constexpr Plates kPlates[] = {{"plates/parallel.rad", 0.1998249}, {"plates/perpendicular.rad", 0.2000436}};

/// The receiver's mean irradiance over the emitter's exitance, by `solve(Scene)`, an engine.
template <class Solve>
double factorOf(const Plates& plates, const Solve& solve) {
  Scene scene = loadScene({bundledScene(plates.name)}).scene;
  PrimitiveId receiver;
  double M = 0;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const auto& emission = scene.materialOf(PrimitiveId(i)).emission;
    if (emission)
      M = kPi * gray(emission->radiance);
    else
      receiver = PrimitiveId(i);
  }
  return meshMean(solve(std::move(scene)), receiver) / M;
}

}  // namespace deltalux::test
