#pragma once
// A solve over stored lines, from a scene to a solution: a pipeline of values, each of which is a function of the scene
// alone. [docs/lines.md]
//
//   particles of lights -> sides and hollows -> coarse light -> mesh -> lines -> exchange -> light -> textures
//
// The coarse light is that of the input level: by it the mesh knows how much light there is about where direct light
// varies.
#include <deltalux/progress.hpp>

#include "solution/solution.hpp"

namespace deltalux::engine {

/// Throws Interrupted where the progress asks to stop; the solution is then unfinished.
void solveByLines(Solution&, Progress*);

}  // namespace deltalux::engine
