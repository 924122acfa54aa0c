#pragma once
// What passes straight through panes, and as a first sight through refracting bodies, by material and angle: a table,
// so that the drawing has the library's own numbers.
#include <deltalux/scene.hpp>

#include "gl/objects.hpp"

namespace deltalux::viewer::gl {

/// Whether one sees through it: thin glass, what is not covered all over, and refracting bodies, which show what is
/// behind them unrefracted until rays have come back.
bool isSeenThrough(const Material&);

class PaneTable {
 public:
  void update(const Scene&, std::uint64_t& uploaded);
  /// By material; 0 where it is not seen through.
  int row(MaterialId m) const { return rows_[m.index()]; }
  GLuint texture() { return texture_.name(); }

 private:
  std::vector<int> rows_;
  std::vector<glm::vec4> texels_;
  Texture2D texture_;
};

}  // namespace deltalux::viewer::gl
