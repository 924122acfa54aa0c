#pragma once
// The camera as OpenGL has it: the rays of View (viewRay) as a matrix, first row of the picture at y = -1.
#include <deltalux/view.hpp>
#include <glm/glm.hpp>

namespace deltalux::viewer::gl {

struct Eye {
  Vec3 position{0}, forward{0}, right{0}, up{0};  // the last three unit
  double halfWidth = 1, halfHeight = 1;           // at unit distance, or in scene units
  bool parallel = false;
};
Eye eyeOf(const View&);

/// Distances along the view between which things are drawn.
struct DepthRange {
  double nearest = 0.01, farthest = 100;
};
/// To clip coordinates; sides that are counter-clockwise seen from outside appear clockwise.
glm::dmat4 toClip(const Eye&, const DepthRange&);

}  // namespace deltalux::viewer::gl
