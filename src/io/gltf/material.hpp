#pragma once
// Materials of glTF as deltalux materials. [glTF 2.0, 3.9 and appendix B; KHR_materials_*]
//
// With base colour b, metalness m, roughness r, ior n:
//   F0      = min(((n-1)/(n+1))^2 specularColor, 1) specular                       [KHR_materials_ior, _specular]
//   diffuse = b (1-m) (1 - max F0), lobe = mix(F0, b, m) as a GGX lobe of alpha = r^2
// The lobe's reflectance is constant over angle, as this project's lobes are (no Fresnel boost). alpha below 1e-3 is a
// perfect mirror. A base colour texture is kept for the diffuse part; the lobe, and every other texture, counts with
// its average (metallic-roughness, emissive) or not at all (normal, occlusion, transmission).
//   KHR_materials_transmission, at least one half after (1-m): thin glass of transmissivity b * transmission; with
//   KHR_materials_volume of some thickness: a dielectric, attenuated by attenuationColor^(length/attenuationDistance).
//   alphaMode BLEND with an alpha below 1: thin glass that lets through 1 - alpha. Masks are ignored.
//   A primitive without material is a grey of 0.5: glTF's own default, a white rough metal, absorbs nothing.
//   KHR_materials_emissive_strength: radiance = emissive * strength / efficacy, from the front unless doubleSided.
#include <deltalux/scene.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// Where a mesh finds the coordinates of its texture.
struct TextureUse {
  int texcoordSet = 0;
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};  // of (u, v, 1) [KHR_texture_transform]
  bool repeats = true;                       // what every texture of a scene does
};

/// What meshes need to know of the materials put into a scene.
struct GltfMaterials {
  MaterialId fallback;                             // of primitives that name none; valid if there are any
  std::vector<std::optional<TextureUse>> texture;  // by glTF material, when it has a diffuse texture
  std::vector<float> metallic;                     // by glTF material
};

/// A material of the same name whose base colour has a factor more, or a texture instead of it whose mean that is.
Material tinted(const Material&, float metallic, const Rgb& factor, TextureId texture);

/// Appends the document's materials, in order, and one for primitives without any, and the textures that they use.
/// Counts what is left out in `ignored`. Throws InputError when a texture that is needed cannot be read.
GltfMaterials addMaterials(const GltfDocument&, double luminousEfficacy, Scene&,
                           std::map<std::string, std::size_t>& ignored);

}  // namespace deltalux::io
