#pragma once
// A mesh that is made again where it is. Its patches are folded to the input level, what has moved is brought to where
// it is now, and what is split as it was before unfolds to the parts it had, at their places: whatever is kept by
// element stays where it is. What does not unfold is away, until the mesh is carried over to new elements: when
// surfaces come or go, or when too much of it is.
#include <span>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// Folds all patches that receive light: the input level remains, as it is built, but for light.
void fold(Elements&);
/// A part begins with the light and the mean free path of the patch it is of, and with nothing of what samples tell.
void inherit(Elements&, ElementId part, ElementId whole);
/// The parts that a folded patch had, with the light and the mean free path of it; false where it had none.
bool unfold(Elements&, ElementId);
/// What has not unfolded does no more.
void forgetFolded(Elements&);
/// How many elements are away.
std::size_t awayIn(const Elements&);

/// Brings surfaces of folded elements to the scene's present shapes, as if they were built of it, but for mean free
/// paths; their parts are forgotten. False where new elements have to be built.
bool bringTo(Elements&, const Scene&, std::span<const PrimitiveId> moved);
/// Takes over the parts that patches of folded elements had, where new elements, nothing of which is
/// split, have the same patch and would split it into the same parts. `stays`: by primitive, whether a surface is where
/// it was. Returns by element of `to` which it was; Id<void>::kNone.
std::vector<std::uint32_t> carryOver(Elements& to, const Scene&, const Elements& from, const std::vector<char>& stays);
/// Leaves out what is away, of elements that are not folded; in the order they are in.
Elements compacted(const Elements&);
/// By element: which it is of those; Id<void>::kNone where it is away.
std::vector<std::uint32_t> numbersWithoutAway(const Elements&);

}  // namespace deltalux::hierarchy
