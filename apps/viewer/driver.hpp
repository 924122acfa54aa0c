#pragma once
// Who drives a viewer in place of hands.
#include <deltalux/image.hpp>
#include <functional>

#include "controller.hpp"
#include "drawing.hpp"

namespace deltalux::viewer {

/// What the window shows, for a driver to look at.
struct DriverView {
  DrawReport drawing;                        // of the frame that was drawn last
  bool drawn = false;                        // since the driver's last turn
  std::function<DisplayImage()> screenshot;  // the picture alone
  std::function<DisplayImage()> window;      // with the panels
  std::function<Image()> radiance;           // before tone mapping [W/(sr m2)]
};

class Driver {
 public:
  virtual ~Driver() = default;
  /// Called once a turn of the window's loop, after drawing. False: close the window.
  virtual bool tick(Controller&, const DriverView&) = 0;
};

}  // namespace deltalux::viewer
