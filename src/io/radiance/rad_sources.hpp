#pragma once
#include <deltalux/scene.hpp>
#include <optional>

#include "io/radiance/modifier_table.hpp"

namespace deltalux::io::radiance {

/// The light of a `source`, patterns aside: a sun when its material is a light of at most 20 degrees across, else a
/// uniform dome. nullopt when the material does not emit or the
/// angle is zero. Throws InputError for a direction of no length and for angles below 0 or above 360 degrees.
std::optional<Light> makeSource(const RadObject&, const Modifier&, const Scene&);

}  // namespace deltalux::io::radiance
