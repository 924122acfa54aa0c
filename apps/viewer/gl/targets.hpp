#pragma once
// What is drawn into: light as floats, the primitive seen first, depths, and the picture for the screen. Rows from the
// top.
#include <deltalux/image.hpp>

#include "gl/objects.hpp"

namespace deltalux::viewer::gl {

struct Targets {
  int width = 0, height = 0;
  Texture2D radiance, primitives, irradiance, depth, paneDepth, display;
  Framebuffer scene;    // radiance, primitives, irradiance where it is asked for; depth
  Framebuffer panes;    // primitives alone, behind depths of their own
  Framebuffer screen;   // display; depth of the scene
  Framebuffer scratch;  // for reading back what is composed

  void resize(int width, int height, bool illuminance);
  /// Depths of the scene, to be drawn on by panes, so that lines behind glass are seen.
  void copyDepthForPanes();

 private:
  bool illuminance_ = false;
};

/// Reads one of the frame's targets; they are bound for reading after it.
template <class Texel>
std::vector<Texel> readTarget(GLuint framebuffer, GLenum attachment, const TextureFormat& f, int width, int height) {
  std::vector<Texel> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadBuffer(attachment);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, f.format, f.type, texels.data());
  return texels;
}

}  // namespace deltalux::viewer::gl
