#pragma once
// A window with an OpenGL 3.3 context, and Dear ImGui in it. It notes what hands have done since the frame before.
#include <deltalux/image.hpp>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace deltalux::viewer {

/// A key that was pressed: GLFW's code, of letters that of the letter on this keyboard, and modifiers.
struct KeyPress {
  int key = 0, modifiers = 0;
};

class Window {
 public:
  /// Throws NoDisplay.
  Window(const std::string& title, int width, int height, bool visible);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Handles what has happened, and waits for it at most so long [s]: 0 not at all, infinity for as long as it takes.
  void handleEvents(double seconds);
  /// Wakes handleEvents(); from any thread.
  static void wake();
  /// Whether hands did anything since the last call.
  bool takeTouched();
  /// Keys pressed since the last call, but those that a text field has taken.
  std::vector<KeyPress> takeKeys();
  bool closing() const;

  /// Begins ImGui's frame; end() draws it over what is there.
  void begin();
  void end();
  void show();  // swaps the buffers

  int width() const;  // of the framebuffer [pixels]
  int height() const;
  /// Size of text and of what fits it, relative to a screen of 96 dots an inch.
  float scale() const { return scale_; }
  /// What was drawn since the last show(), panels and all.
  DisplayImage capture() const;

 private:
  struct Callbacks;
  GLFWwindow* window_ = nullptr;
  float scale_ = 1;
  bool touched_ = true;
  std::vector<KeyPress> keys_;
};

}  // namespace deltalux::viewer
