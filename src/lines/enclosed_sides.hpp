#pragma once
// Which sides of surfaces face hollows that no light reaches: the insides of logs, legs and cushions. What lies there
// takes no part, and covers what it stands on. [lines.md]
#include <functional>
#include <span>

#include "base/box_tree.hpp"
#include "hierarchy/patch.hpp"
#include "lines/follow_line.hpp"

namespace deltalux::lines {

/// Walks that looked for light from a side, and where they ran: where nothing has changed there, they would find the
/// same again.
struct LightWalks {
  std::vector<LineSegment> steps;
  BoxF box;               // that holds the rest of them: many short ones
  bool enclosed = false;  // they have found none, in a hollow too small to be a room
  LightId found;          // by a shadow ray; none where they ended otherwise
  std::vector<hierarchy::PatchPoint> asked;  // of what is enclosed: where each of the shadow rays began
};

/// Whether walks of a side would run where they ran, up to where they saw a light.
using WalksHold = std::function<bool(hierarchy::ElementId, const LightWalks&)>;
inline bool nothingHolds(hierarchy::ElementId, const LightWalks&) { return false; }

/// By element, of the input level: those that do not hold are walked again. `movedLights`, by light: those that are
/// elsewhere than the walks knew them; where others were found, those are found still, and where none was, these alone
/// are looked for. May be empty, for none. Returns how many rays that took.
std::uint64_t walkForLight(const hierarchy::Elements&, const LineTracer&, const WalksHold&,
                           std::span<const char> movedLights, std::vector<LightWalks>&);

}  // namespace deltalux::lines
