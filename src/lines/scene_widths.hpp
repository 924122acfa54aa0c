#pragma once
// Lengths that lines are held against: metres, but less in small scenes.
#include <deltalux/scene.hpp>

namespace deltalux::lines {

struct SceneWidths {
  double farthest = 0;  // what lines out of the scene count as: its diagonal, to the nearest half of an octave, so that
                        // they count as the same when something moves at its rim
  double hollow = 0;    // mean distance below which a hollow is enclosed where walks find no light
  double room = 0;      // mean distance above which a place is a room: no slot where it is lit, worth lines in the dark

  friend bool operator==(const SceneWidths&, const SceneWidths&) = default;
};

/// Of a scene with surfaces in such a box [scene units].
SceneWidths widthsOf(const Scene&, const Box&);

}  // namespace deltalux::lines
