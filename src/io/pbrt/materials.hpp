#pragma once
// pbrt's materials. Roughness is GGX's alpha, or its square where it is remapped, as it is unless a scene says
// otherwise.
#include "io/pbrt/colours.hpp"

namespace deltalux::io::pbrt {

/// Materials by name, for mixtures.
using NamedMaterials = std::map<std::string, Entity*, std::less<>>;

/// Throws InputError.
Material materialOf(Context&, const NamedMaterials&, const Entity&, int depth = 0);

}  // namespace deltalux::io::pbrt
