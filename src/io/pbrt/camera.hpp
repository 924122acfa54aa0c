#pragma once
// pbrt's cameras, which look along z with x to the right and y up: a left-handed frame.
#include <deltalux/view.hpp>

#include "io/pbrt/colours.hpp"

namespace deltalux::io::pbrt {

/// The view of a camera whose film (null: pbrt's own) tells the picture's shape; nullopt, and counted, for a kind that
/// is not read. A warning says where pbrt's pictures are the mirror image of ours, as those of left-handed scenes are.
/// Throws InputError.
std::optional<View> viewOf(Context&, const Entity& camera, const Entity* film, const Mat4& fromWorld);

}  // namespace deltalux::io::pbrt
