#pragma once
// Pictures for tests: wide range, runs of equal pixels, noise, black.
#include <cmath>
#include <deltalux/image.hpp>

#include "base/random.hpp"

namespace deltalux::test {

/// Left third constant, middle third noise over nine decades, right third black; deterministic.
inline Image mixedImage(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  Rng rng(7);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto noise = [&] { return static_cast<float>(std::pow(10.0, 9.0 * rng.uniform() - 5.0)); };
      if (3 * x < width)
        image.pixels.push_back({0.25f, 0.5f, 3.0f});
      else if (3 * x < 2 * width)
        image.pixels.push_back({noise(), noise(), noise()});
      else
        image.pixels.push_back(Rgb(0.0f));
    }
  return image;
}

}  // namespace deltalux::test
