#pragma once
#include <deltalux/math.hpp>
#include <string>

namespace deltalux {

/// A camera as Radiance's view options say it: -vtv/-vtl, -vp, -vd, -vu, -vh, -vv.
struct View {
  enum class Kind { Perspective, Parallel };
  std::string name;
  Kind kind = Kind::Perspective;
  Vec3 position{0};
  Vec3 direction{0, 1, 0};  // need not be unit
  Vec3 up{0, 0, 1};
  double horizontal = 45;  // full angle in degrees (perspective) or width in scene units (parallel)
  double vertical = 45;
};

/// A ray of the view. x in [0,1] from left to right, y in [0,1] from top to bottom; direction is unit.
struct ViewRay {
  Vec3 origin, direction;
};
ViewRay viewRay(const View&, double x, double y);

/// Width and height in pixels with the view's own aspect ratio inside `maxWidth` x `maxHeight`.
glm::ivec2 fitResolution(const View&, int maxWidth, int maxHeight);

}  // namespace deltalux
