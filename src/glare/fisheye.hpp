#pragma once
// Pixels of a fisheye picture, each as the direction of its middle and its solid angle.
#include <deltalux/glare.hpp>

namespace deltalux::glare {

struct FisheyePixel {
  Vec3 direction;
  double solidAngle;  // [sr]
};

/// Of a square picture of `size` pixels; nullopt where the middle lies beyond the rim.
std::optional<FisheyePixel> fisheyePixel(const Eye&, int size, int x, int y);

}  // namespace deltalux::glare
