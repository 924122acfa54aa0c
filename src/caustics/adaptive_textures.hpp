#pragma once
// Caustic textures of one side of a surface, with nothing to set but the target error [GD01 3]:
//   1. Does what was deposited depart from what a mesh can show?            choice.hpp
//   2. Which parts of the surface need fine texels?                          restriction.hpp
//   3. Texels down to what the particles can tell, in each part.           resolution.hpp
//   4. Kernels as wide as the particles allow, texel by texel.             adaptive_kernel.hpp
// The rest of the surface keeps a coarse texture, cut out where the fine ones are, which fade into it
// (low_frequency_layer.hpp). Every particle is in exactly one. Cost: about 0.25 microseconds a texel.
#include <optional>

#include "caustics/caustic_texture.hpp"
#include "particles/impact.hpp"

namespace deltalux::caustics {

struct CausticSettings {
  double error = 0.05;  // target relative error of irradiance
  // Gray irradiance of all other light on this side [W/m2]: what errors are measured against too.
  double background = 0;  // on average
  double darkest = 0;     // where there is little of it
};

/// Whether textures should show these impacts on one side of a surface, or the mesh: step 1.
bool deservesTextures(const Shape&, std::span<const particles::Impact>, const CausticSettings&);

/// All steps; nullopt where the mesh will do.
std::optional<SurfaceCaustics> makeCausticTextures(const Shape&, std::span<const particles::Impact>,
                                                   const CausticSettings&);

/// The same with one texture a chart, not restricted to where it is needed: to see what restriction does. `texels`: of
/// each texture.
SurfaceCaustics makeUnrestrictedTextures(const Shape&, std::span<const particles::Impact>, const CausticSettings&,
                                         int texels);

}  // namespace deltalux::caustics
