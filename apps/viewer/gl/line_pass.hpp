#pragma once
// Lines over the picture: the frame's own, and the outlines of patches.
#include "drawing.hpp"
#include "gl/surface_passes.hpp"

namespace deltalux::viewer::gl {

class LinePass {
 public:
  /// Into the framebuffer that is bound. Return the bytes uploaded.
  std::uint64_t drawOutlines(const SurfaceView&);
  std::uint64_t drawLines(const SurfaceView&, const std::vector<Line>&);

 private:
  void use(const SurfaceView&, bool section);

  Program plain_, cut_;
  Buffer vertices_;
  VertexArray array_;
};

}  // namespace deltalux::viewer::gl
