#include "gl/draw_state.hpp"

namespace deltalux::viewer::gl {

DrawState::DrawState() {
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
  glGetIntegerv(GL_VIEWPORT, viewport_);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CW);  // rows run from the top (projection.hpp)
}

DrawState::~DrawState() {
  for (const GLenum what : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_BLEND}) glDisable(what);
  for (GLenum i = 0; i < 6; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
  glFrontFace(GL_CCW);
  glBindVertexArray(0);
  glUseProgram(0);
  glActiveTexture(GL_TEXTURE0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
}

void cutAtSection(bool on) {
  for (GLenum i = 0; i < 6; ++i) on ? glEnable(GL_CLIP_DISTANCE0 + i) : glDisable(GL_CLIP_DISTANCE0 + i);
}

}  // namespace deltalux::viewer::gl
