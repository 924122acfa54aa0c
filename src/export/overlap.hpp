#pragma once
// Where surfaces of different planes meet, their outlines have different vertices, and a graphics card leaves single
// pixels uncovered between them: what shines behind would sparkle there. Every side is therefore drawn a little larger.
#include "export/page_mesh.hpp"

namespace deltalux::exporting {

/// Moves the outlines of all sides outwards, each in its own plane, by `width` [scene units].
void widenSides(PageMesh&, double width);

}  // namespace deltalux::exporting
