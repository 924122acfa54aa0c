#pragma once
// Which sides a camera may see: told by their boxes, and where they are flat by the way they face. Costs a few
// operations a side, and saves the drawing of all their triangles.
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "gl/projection.hpp"

namespace deltalux::viewer::gl {

/// Where a side is, and the way it faces.
struct Extent {
  glm::vec3 lower{0.0f}, upper{0.0f};
  glm::vec3 normal{0.0f};  // of a flat one; else 0
  float offset = 0;        // flat: least of dot(normal, p) over its points

  bool flat() const { return normal != glm::vec3(0.0f); }
};
/// The box of one that a matrix moves; flat no more.
Extent moved(const Extent&, const glm::mat4&);

/// The pixels among which a box appears; all of them where it reaches behind the eye.
struct ScreenBox {
  glm::vec2 lower{0.0f}, upper{0.0f};
};
ScreenBox screenBox(const Extent&, const glm::mat4& toClip, int width, int height);

class Visibility {
 public:
  Visibility(const Eye&, const std::optional<Box>& section);
  bool sees(const Extent&) const;
  /// From the eye to the nearest point of its box.
  double distance(const Extent&) const;
  /// Takes it into the range of depths.
  void include(const Extent&);
  /// Of all that was included, as near as may be: that is what precision of depth depends on.
  DepthRange depths() const;

 private:
  Eye eye_;
  std::optional<Box> section_;
  std::array<glm::vec4, 4> planes_;  // left, right, top, bottom; positive inside
  double nearest_, farthest_ = 0;
};

}  // namespace deltalux::viewer::gl
