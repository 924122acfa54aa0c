#pragma once
// Lamps as things with a place and an aim, whatever kind of light they are.
#include <deltalux/scene.hpp>
#include <optional>

namespace deltalux::viewer {

/// Where a light is, in the scene's coordinates: an area light in the middle of its surface. nullopt: at infinity, or
/// of a surface that was removed.
std::optional<Vec3> placeOf(const Scene&, LightId);
/// In which direction it shines most, unit: spots and cones along their axis, measured lights along theirs, surfaces
/// along their normal. nullopt: no direction is any better than another.
std::optional<Vec3> aimOf(const Scene&, LightId);
/// Full angle of its cone, in degrees: of what a camera in its place should see; 90 where nothing bounds it.
double openingOf(const Scene&, LightId);

}  // namespace deltalux::viewer
