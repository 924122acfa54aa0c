#pragma once
// Mitsuba's shapes, in their own coordinates.
#include <deltalux/shape.hpp>

#include "io/mitsuba/materials.hpp"

namespace deltalux::io::mitsuba {

/// Before to_world; nullopt for a kind that is not read. Throws InputError.
std::optional<std::vector<Shape>> shapesOf(const Context&, const Properties&);

}  // namespace deltalux::io::mitsuba
