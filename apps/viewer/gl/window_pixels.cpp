#include "gl/window_pixels.hpp"

#include <epoxy/gl.h>

namespace deltalux::viewer::gl {

void clearWindow(int width, int height, float grey) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, width, height);
  glClearColor(grey, grey, grey, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

DisplayImage windowPixels(int width, int height) {
  DisplayImage image;
  image.width = width, image.height = height;
  image.pixels.resize(static_cast<std::size_t>(width) * height);
  std::vector<std::array<std::uint8_t, 3>> rows(image.pixels.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
  for (int y = 0; y < height; ++y)  // OpenGL has its rows from the bottom
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(height - 1 - y) * width, width,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(y) * width);
  return image;
}

}  // namespace deltalux::viewer::gl
