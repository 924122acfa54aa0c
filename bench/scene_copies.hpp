#pragma once
// k copies of a scene side by side on a grid: how cost grows with a scene. Suns and skies are shared.
#include <deltalux/scene.hpp>

namespace deltalux::bench {

/// Objects of copy i > 0 are named "copy<i>.NAME"; lights at a place are copied, lights at infinity are not.
Scene sideBySide(const Scene&, int copies);

}  // namespace deltalux::bench
