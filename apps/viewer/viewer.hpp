#pragma once
// The interactive viewer: a window on a scene while it is solved, edited and looked at.
#include <functional>
#include <stdexcept>

#include "controller.hpp"
#include "gl/renderer.hpp"

namespace deltalux::viewer {

class Window;

/// There is no display, or no OpenGL 3.3 on it; what() says what is missing, and which commands do without.
class NoDisplay : public std::runtime_error {
 public:
  explicit NoDisplay(const std::string& missing);
};

/// Drives the viewer without hands, such as a script.
class Driver {
 public:
  virtual ~Driver() = default;
  /// Once, before the first tick. The window outlives the driver's last tick.
  virtual void attach(Window&) {}
  /// Once per turn of the loop, after drawing and before the window shows it: Window::capture() has it, panels and all.
  /// `drawn` is of the last frame. False closes the window.
  virtual bool tick(Controller&, gl::Renderer&, const DrawReport& drawn) = 0;
  /// Whether the next turn has to draw though nothing is new: what tick() has done may show. A driver that only waits
  /// returns false, which leaves the processor to the solver.
  virtual bool wantsFrame() const { return true; }
};

struct ViewerOptions {
  Controller::Source source;
  Solver::Settings solver;
  std::string title;               // what is opened
  int width = 1280, height = 800;  // of the window [pixels]
  std::optional<double> ev;        // exposure to begin with [stops]; else it is found once from the first picture
  bool panels = true;              // beside the picture, which fills the window otherwise
  bool visible = true;             // false: the window is drawn into and never shown
  Driver* driver = nullptr;        // none: hands alone
};

/// Opens the window, and returns once it is closed. Throws NoDisplay; InputError when what was to be opened cannot be.
void runViewer(const ViewerOptions&);

}  // namespace deltalux::viewer
