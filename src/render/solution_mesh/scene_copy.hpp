#pragma once
// Whether a copy of a scene still is like the scene, as far as edits can change that.
#include <deltalux/scene.hpp>

namespace deltalux::rendering {

/// `copy` is of the same scene at some time before.
bool isUpToDate(const Scene& copy, const Scene& now);
/// The same of the shapes alone.
bool hasSameShapes(const Scene& copy, const Scene& now);

}  // namespace deltalux::rendering
