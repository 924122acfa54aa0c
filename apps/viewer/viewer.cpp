#include "viewer.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <limits>

#include "gl/window_pixels.hpp"
#include "hands.hpp"
#include "panels/legend.hpp"
#include "panels/measure_panel.hpp"
#include "panels/scene_panel.hpp"
#include "panels/sidebar.hpp"
#include "panels/state_panel.hpp"
#include "panels/status_line.hpp"
#include "window.hpp"

namespace deltalux::viewer {

namespace {
constexpr float kGrey = 0.2f;           // before there is anything to look at
constexpr int kFramesAfterTouch = 3;    // ImGui needs some to come to rest after the last event
constexpr double kDriverPause = 0.005;  // between a driver's turns where nothing has to be drawn [s]

std::unique_ptr<gl::Renderer> makeRenderer() {
  try {
    return std::make_unique<gl::Renderer>();
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw NoDisplay(error.what());
  }
}

class Loop {
 public:
  explicit Loop(const ViewerOptions& options)
      : options_(options),
        window_("deltalux: " + options.title, options.width, options.height, options.visible),
        renderer_(makeRenderer()),
        controller_(options.source, options.solver) {
    tools_.panels = options.panels;
    if (options.ev) controller_.draw().tone.ev = *options.ev;
    controller_.solver().onChange([] { Window::wake(); });
  }
  ~Loop() { controller_.solver().onChange({}); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  void run() {
    untilClosed();
    if (!controller_.ready()) failWith(controller_.status());
  }

 private:
  void untilClosed() {
    if (options_.driver) options_.driver->attach(window_);
    while (!window_.closing()) {
      window_.handleEvents(patience());
      if (window_.takeTouched()) due_ = kFramesAfterTouch;
      const bool changed = controller_.takeChanges();
      if (options_.driver) failWith(controller_.status());
      const bool driven = options_.driver && options_.driver->wantsFrame();
      const bool drawing = changed || driven || due_ > 0 || hands_.moving();
      if (drawing) frame();
      if (options_.driver && !options_.driver->tick(controller_, *renderer_, drawn_)) return;
      if (drawing) shown();
    }
  }

  /// How long the loop may sleep [s].
  double patience() const {
    if (due_ > 0 || hands_.moving()) return 0;
    if (options_.driver) return options_.driver->wantsFrame() ? 0 : kDriverPause;
    return std::numeric_limits<double>::infinity();
  }

  /// Nobody reads the window while a driver has it, or once it is closed.
  void failWith(const Status& status) const {
    if (status.phase == Phase::Failed) throw InputError(options_.title, 0, status.message);
  }

  float pictureWidth() const {  // in ImGui's units
    const float whole = ImGui::GetIO().DisplaySize.x;
    return tools_.panels ? std::max(whole - Sidebar::width(), 1.0f) : whole;
  }

  void frame() {
    due_ = std::max(due_ - 1, 0);
    window_.begin();
    const float scale = ImGui::GetIO().DisplayFramebufferScale.x;
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    controller_.setSize(int(std::lround(pictureWidth() * scale)), window_.height());
    const std::vector<KeyPress> keys = window_.takeKeys();
    if (controller_.ready()) hands_.update(controller_, tools_, controller_.frame(), keys, seconds);
    const Frame picture = controller_.frame();
    panels(picture, scale);
    gl::clearWindow(window_.width(), window_.height(), kGrey);
    if (controller_.ready()) {
      drawn_ = renderer_->draw(picture, &controller_.cache());
      expose();
    }
    window_.end();
  }

  /// After drawing. The first picture's exposure is found and kept, unless one was given.
  void expose() {
    if (!exposed_ && !options_.ev) controller_.automaticExposure();
    exposed_ = true;
    if (!controller_.exposureWanted()) return;
    controller_.wantExposureFrom(renderer_->radiance());
    due_ = kFramesAfterTouch;
  }

  void panels(const Frame& picture, float scale) {
    const float width = pictureWidth(), height = ImGui::GetIO().DisplaySize.y;
    if (!controller_.ready()) {
      openingNotice(controller_.status(), options_.title, ImGui::GetIO().DisplaySize.x, height);
      return;
    }
    drawLegend(picture.settings.falseColour, height, statusHeight());
    wipeLine(tools_, width, height);
    if (!options_.driver || tools_.panels) {
      hands_.draw(controller_, picture);
      measureMarks(controller_, tools_, picture, scale);
    }
    if (picture.settings.overlays.statistics) statistics(controller_, drawn_, width);
    keyList(tools_);
    if (!tools_.panels) return;
    statusLine(controller_, tools_, width, height);
    sidebar_.draw(controller_, tools_, *renderer_, width, height);
  }

  void shown() {
    window_.show();
    if (controller_.ready()) controller_.drawn(renderer_->specularPixels());
  }

  const ViewerOptions& options_;
  Window window_;
  std::unique_ptr<gl::Renderer> renderer_;
  Controller controller_;
  Tools tools_;
  Hands hands_;
  Sidebar sidebar_;
  DrawReport drawn_;
  int due_ = kFramesAfterTouch;
  bool exposed_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
}  // namespace

void runViewer(const ViewerOptions& options) { Loop(options).run(); }

}  // namespace deltalux::viewer
