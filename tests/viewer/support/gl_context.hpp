#pragma once
// An OpenGL 3.3 core context without a display, by EGL's surfaceless platform.
#include <memory>

namespace deltalux::viewer {

class GlContext {
 public:
  /// Makes one and makes it current, with a framebuffer of that size bound. null where there is none.
  static std::unique_ptr<GlContext> make(int width, int height);
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  ~GlContext();

 private:
  GlContext() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace deltalux::viewer
