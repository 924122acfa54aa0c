#pragma once
// Present states of things of a scene, as a Restore has them.
#include <deltalux/edit.hpp>

namespace deltalux::viewer {

/// The present state of all that `things` names.
Restore presentState(const Scene&, const Restore& things);
/// Whether `later` is about all that `earlier` is about, as one position of a drag is after another: then applying both
/// is applying `later`. False where it would take a search to tell.
bool covers(const Restore& later, const Restore& earlier);

}  // namespace deltalux::viewer
