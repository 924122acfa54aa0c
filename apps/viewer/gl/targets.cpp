#include "gl/targets.hpp"

#include <stdexcept>

namespace deltalux::viewer::gl {

namespace {
void attach(GLenum attachment, GLuint texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void checkComplete() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL has no framebuffers of 32 bit floats");
}
}  // namespace

void Targets::resize(int w, int h, bool illuminance) {
  if (w == width && h == height && illuminance == illuminance_) return;
  width = w, height = h, illuminance_ = illuminance;
  radiance.resize(kRgba32F, w, h);
  primitives.resize(kR32Ui, w, h);
  irradiance.resize(kRgba32F, illuminance ? w : 1, illuminance ? h : 1);
  depth.resize(kDepth, w, h);
  paneDepth.resize(kDepth, w, h);
  display.resize(kRgba8, w, h);

  glBindFramebuffer(GL_FRAMEBUFFER, scene.name());
  attach(GL_COLOR_ATTACHMENT0, radiance.name());
  attach(GL_COLOR_ATTACHMENT1, primitives.name());
  attach(GL_COLOR_ATTACHMENT2, illuminance ? irradiance.name() : 0);
  attach(GL_DEPTH_ATTACHMENT, depth.name());
  checkComplete();
  glBindFramebuffer(GL_FRAMEBUFFER, panes.name());
  attach(GL_COLOR_ATTACHMENT1, primitives.name());
  attach(GL_DEPTH_ATTACHMENT, paneDepth.name());
  const GLenum second[] = {GL_NONE, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, second);
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  checkComplete();
  glBindFramebuffer(GL_FRAMEBUFFER, screen.name());
  attach(GL_COLOR_ATTACHMENT0, display.name());
  attach(GL_DEPTH_ATTACHMENT, depth.name());
  checkComplete();
}

void Targets::copyDepthForPanes() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, scene.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, panes.name());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

}  // namespace deltalux::viewer::gl
