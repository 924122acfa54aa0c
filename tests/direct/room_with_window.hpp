#pragma once
// A black room of 4 x 4 x 3 under a sky of radiance 3, with a window of 0.6 x 0.6 in the wall at x = 4, and a small
// lamp.
#include "support/solved.hpp"

namespace deltalux::test {

inline Scene roomWithWindow() {
  Scene scene;
  const MaterialId black = addMaterial(scene, "black", lambert(0));
  addPolygon(scene, black, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  addPolygon(scene, black, {{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
  addPolygon(scene, black, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  addPolygon(scene, black, {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  addPolygon(scene, black, {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  addPolygon(scene, black,
             {{4, 0, 0},
              {4, 0, 3},
              {4, 4, 3},
              {4, 4, 0},
              {4, 0, 0},
              {4, 1.6, 1.2},
              {4, 2.2, 1.2},
              {4, 2.2, 1.8},
              {4, 1.6, 1.8},
              {4, 1.6, 1.2}});
  scene.primitives.push_back({Sphere{{2, 3, 2.5}, 0.1},
                              addMaterial(scene, "lamp", lambert(0), Emission{Rgb(2.0f), false, std::nullopt}),
                              ObjectId()});
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  addAreaLights(scene);
  return scene;
}

}  // namespace deltalux::test
