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

/// Walks of a side that are what they would be now; nullptr where none are known.
using KnownWalks = std::function<LightWalks*(hierarchy::ElementId)>;
inline LightWalks* nothingKnown(hierarchy::ElementId) { return nullptr; }

/// By element, of the input level. Walks that are known are taken.
std::vector<LightWalks> walkForLight(const hierarchy::Elements&, const LineTracer&, const KnownWalks&,
                                     std::uint64_t& rays);

}  // namespace deltalux::lines
