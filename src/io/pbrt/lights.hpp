#pragma once
// pbrt's lights. Numbers of rgb stand as they are, `scale` times; a spectrum tells the colour alone, at luminance 1;
// and where there is a `power`, that of rgb 1 is meant, in watts here.
#include "io/pbrt/colours.hpp"

namespace deltalux::io::pbrt {

/// Adds it, or counts it. Throws InputError.
void addLight(Context&, Scene&, const Entity&, const Mat4& toWorld);

/// What shines of a surface of that area, all of it together [scene units^2]; nullopt for a light that is black, or not
/// read and counted. Throws InputError.
std::optional<Emission> emissionOf(Context&, const Entity&, double area);

}  // namespace deltalux::io::pbrt
