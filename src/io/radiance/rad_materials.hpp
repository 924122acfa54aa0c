#pragma once
#include <deltalux/material.hpp>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// What a supported material does. `alternate` is the surface that a mirror or illum names instead of its own, if any.
/// Throws InputError for colours and fractions that no material has.
///
/// plastic, metal: specular share `spec`, diffuse colour (1 - spec); plastic's lobe is uncoloured, metal's coloured.
/// plastic2, metal2, trans2: as the isotropic one of mean roughness. trans: the share (1 - spec) is split by
/// `transmission` into reflection and transmission, the latter by `transmitted-specular` into a lobe and a diffuse
/// part. [Radiance, materials.pdf]
Material makeMaterial(const RadObject&, const Material* alternate);

}  // namespace deltalux::io::radiance
