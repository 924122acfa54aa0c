#pragma once
// What samples from before an edit are still worth: all that they have found is what they would find now, where none of
// their rays starts or passes where something has moved.
#include "change/moved_space.hpp"
#include "direct/lamps.hpp"
#include "lines/first_lines.hpp"

namespace deltalux::change {

/// Whether a patch's first lines, and what they tell of its surroundings, are as they were. `patch`: as it is now.
bool holdFirstLines(const MovedSpace&, const hierarchy::Elements&, const Scene&, hierarchy::ElementId patch,
                    const lines::FirstLines&);
/// Whether shadow rays of a patch to suns and lamps are.
bool holdShadowRays(const MovedSpace&, const direct::Lamps&, const hierarchy::Elements&, hierarchy::ElementId patch);

/// `lines` from before as they are now: `escaped` of them, ascending by leaf; `of` by leaf there is: the leaf of
/// `lines` that it was where it stands, or kNone; what they were over (`before`) and are over now.
lines::KnownLines knownLines(const MovedSpace&, lines::Lines lines, std::span<const lines::EscapedLine> escaped,
                             std::vector<std::uint32_t> of, const hierarchy::Elements& before,
                             const hierarchy::LeafTable& leavesBefore);

}  // namespace deltalux::change
