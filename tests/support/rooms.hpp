#pragma once
// Small scenes made in code: boxes seen from inside, blocks seen from outside, lamps.
#include <deltalux/scene.hpp>

namespace deltalux::test {

/// Adds a material and returns its id.
MaterialId addMaterial(Scene&, std::string name, Surface, std::optional<Emission> = {});
/// Lambertian of the same reflectance in every channel.
Opaque lambert(float reflectance);

/// Adds the six faces of a box whose fronts look inwards (a room) or outwards (a block).
void addBox(Scene&, MaterialId, const Vec3& lower, const Vec3& upper, bool inward);
/// Adds a block as an object of its own, which can be moved.
void addBlock(Scene&, std::string name, MaterialId, const Vec3& lower, const Vec3& upper);
/// Adds the polygon of `vertices`, counter-clockwise seen from its front.
PrimitiveId addPolygon(Scene&, MaterialId, std::vector<Vec3> vertices);
PrimitiveId addShape(Scene&, MaterialId, Shape);
void addLight(Scene&, decltype(Light::emitter));

}  // namespace deltalux::test
