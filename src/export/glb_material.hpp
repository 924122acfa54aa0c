#pragma once
// Materials of a scene in glTF's terms.
//
//   Opaque      a specular lobe is KHR_materials_specular over the diffuse colour, or metal where nothing is diffuse;
//   no
//               lobe is a specular factor of 0. Roughness is the root of the lobe's alpha, whatever its distribution.
//   Mirror      metal of roughness 0; black behind.
//   ThinGlass   KHR_materials_transmission, KHR_materials_ior.
//   Dielectric  the same with KHR_materials_volume, attenuated per metre.
//   Trans       its reflection; what it lets through has no place in glTF without further extensions.
//   coverage    alpha, blended.
//   emission    L [W/(sr m2)] along the normal, in KHR_materials_emissive_strength where a channel is above 1.
#include <deltalux/scene.hpp>
#include <deltalux/solution_mesh.hpp>
#include <optional>

#include "export/glb_container.hpp"

namespace deltalux::exporting {

/// The material of a side, without textures. Notes the extensions that it uses.
GlbJson litMaterial(GlbContainer&, const Scene&, const SurfaceMesh& side);

/// Shown as it is: `colour` (linear) times the texture of the atlas, if any. Panes are see-through by their
/// transmittance along the normal, covered surfaces by their coverage.
GlbJson unlitMaterial(GlbContainer&, const Material&, const Rgb& colour, std::optional<std::size_t> texture);

}  // namespace deltalux::exporting
