#pragma once
#include <deltalux/scene.hpp>

#include "run_options.hpp"

namespace deltalux::cli {

/// Says so when nothing in the scene gives light: all that is measured or shown of it is black.
void warnIfDark(const Scene&, const Run&);

}  // namespace deltalux::cli
