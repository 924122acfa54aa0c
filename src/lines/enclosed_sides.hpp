#pragma once
// Which sides of surfaces face hollows that no light reaches: the insides of logs, legs and cushions. What lies there
// takes no part, and covers what it stands on. [lines.md]
#include <functional>

#include "base/box_tree.hpp"
#include "hierarchy/element.hpp"
#include "lines/follow_line.hpp"

namespace deltalux::lines {

/// Walks that looked for light from a side, and where they ran: where nothing has changed there, they would find the
/// same again.
struct LightWalks {
  std::vector<LineSegment> steps;
  BoxF box;               // that holds the rest of them: many short ones
  bool enclosed = false;  // they have found none, in a hollow too small to be a room
};

/// Whether walks of a side are what they would be now.
using WalksHold = std::function<bool(hierarchy::ElementId, const LightWalks&)>;
inline bool nothingHolds(hierarchy::ElementId, const LightWalks&) { return false; }

/// By element, of the input level: those that do not hold are walked again. Returns how many rays that took.
std::uint64_t walkForLight(const hierarchy::Elements&, const LineTracer&, const WalksHold&, std::vector<LightWalks>&);

}  // namespace deltalux::lines
