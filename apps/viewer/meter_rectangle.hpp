#pragma once
// Rectangles of meters, measured out by two points on a surface.
#include <deltalux/solution_reader.hpp>
#include <optional>

#include "controller.hpp"

namespace deltalux::viewer {

/// A rectangle of meters with two points as its corners, in the plane of the first: its sides run level and across from
/// that, on a level surface along the scene's axes. nullopt where the points span none. `up` is unit.
std::optional<MeterField> fieldBetween(const SurfaceHit& corner, const Vec3& opposite, const Vec3& up);

}  // namespace deltalux::viewer
