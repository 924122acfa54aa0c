#pragma once
// Pictures inside a .glb, as PNG.
#include <deltalux/image.hpp>
#include <deltalux/scene.hpp>

#include "export/glb_container.hpp"

namespace deltalux::exporting {

/// Adds image, texture and sampler; the number of the texture. Held at its edges and without smaller copies: those
/// would mix charts.
std::size_t addAtlasTexture(GlbContainer&, const std::string& png, const std::string& name);
/// A texture of the scene, sRGB-encoded, repeated.
std::size_t addSceneTexture(GlbContainer&, const Texture&);

/// PNG of value / white in eight linear bits, rounded and clipped; and of value / intensity in RGBM (rgbm.hpp).
std::string linearPng(const Image&, float white);
std::string rgbmPng(const Image&, float intensity);

}  // namespace deltalux::exporting
