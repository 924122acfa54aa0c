#pragma once
// From what a file measured to all directions, as type C: I(vertical, horizontal) with vertical 0 along the aim (-z),
// 90/0 along +x, horizontal angles counter-clockwise seen from above (towards +y). [LM-63, 2002; EXT_lights_ies]
//
// Type C: one plane is axial symmetry; 0-90 quadrants; 0-180 symmetry about the plane 0-180; 90-270 (LM-63-1995) about
// the plane 90-270; anything up to 360 wraps round. Vertical angles outside the file's range get no light, with a step.
//
// Types A and B turn about an axis across the aim, with their point (0,0) in the aim, vertical angles towards +x and
// horizontal angles clockwise (towards -y). With x, y, z the direction's components:
//   A: polar axis x.  V = asin(x), H = atan2(-y, -z).
//   B: polar axis y.  V = atan2(x, -z), H = asin(-y).
// Angles that start at 0 are mirrored (the other half of a symmetric luminaire), one single horizontal angle means
// axial symmetry about the aim, nothing shines outside the range. They are resampled at the finest step of the file,
// but at least 0.5 and at most 5 degrees: finer detail than that is lost.
#include <deltalux/light.hpp>
#include <string>

#include "io/ies/parse.hpp"

namespace deltalux::io {

/// Throws InputError when the angles are none that the standard knows; `name` is the file in messages. Appends to
/// `record.warnings`.
Photometry completePhotometry(IesRecord& record, const std::string& name);

}  // namespace deltalux::io
