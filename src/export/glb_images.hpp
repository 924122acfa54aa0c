#pragma once
// Pictures inside a .glb, as PNG.
#include <deltalux/image.hpp>
#include <deltalux/scene.hpp>

#include "export/glb_container.hpp"

namespace deltalux::exporting {

/// Adds image, texture and sampler; the number of the texture. Held at its edges and without smaller copies: those
/// would mix charts.
std::size_t addAtlasTexture(GlbContainer&, const DisplayImage&, const std::string& name);
/// A texture of the scene, sRGB-encoded, repeated.
std::size_t addSceneTexture(GlbContainer&, const Texture&);

/// Eight bits of value / white, linear, rounded and clipped.
DisplayImage linearPicture(const Image&, float white);

}  // namespace deltalux::exporting
