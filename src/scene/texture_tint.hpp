#pragma once
#include <deltalux/scene.hpp>

namespace deltalux::scene {

/// The texture of a surface's diffuse colour; invalid where it has none, or no coordinates for it.
TextureId diffuseTexture(const Scene&, PrimitiveId);
/// Factor of the diffuse colour at a point of a textured mesh; 1 on every other surface.
Rgb textureTint(const Scene&, PrimitiveId, std::uint32_t triangle, const Vec3& position);

}  // namespace deltalux::scene
