#pragma once
// The caustic textures of a side as textures and triangles that any renderer can draw: what bilinear interpolation
// shows of them is what SurfaceCaustics::irradianceAt finds.
//
// Texels that know nothing, beyond an outline, take on what their neighbours know. Textures that go on beyond their
// rims (round a closed surface, over a pole) get a border of what is there.
#include <deltalux/scene.hpp>
#include <deltalux/solution_mesh.hpp>

#include "caustics/caustic_texture.hpp"

namespace deltalux::rendering {

/// `side`: the same side, whose triangles curved surfaces take. Version 0. Cost: a visit per texel, and a clipping per
/// triangle and texture.
SurfaceCausticMesh causticMeshOf(const caustics::SurfaceCaustics&, const Shape&, const SurfaceMesh& side);

bool sameTextures(const SurfaceCausticMesh&, const SurfaceCausticMesh&);

}  // namespace deltalux::rendering
