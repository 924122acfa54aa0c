#pragma once
// Means of pbrt's textures.
#include "io/pbrt/colours.hpp"

namespace deltalux::io::pbrt {

/// The mean of the texture that a parameter names. Throws InputError.
Rgb meanOfTexture(Context&, const Parameter&);

}  // namespace deltalux::io::pbrt
