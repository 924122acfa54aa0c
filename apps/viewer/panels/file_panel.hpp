#pragma once
// Saving: the picture, the solution, the session's edits.
#include <memory>
#include <mutex>

#include "gl/renderer.hpp"
#include "tools.hpp"

namespace deltalux::viewer {

/// Names that are being typed, and what became of the last one. The solver's thread tells, too.
class FilePanel {
 public:
  void draw(Controller&, const gl::Renderer&);

 private:
  struct Outcome {
    std::mutex mutex;
    std::string text;
  };
  void tell(const std::string&);
  void savePicture(Controller&, const gl::Renderer&);
  void saveSolution(Controller&);
  void saveSession(Controller&);

  static constexpr std::size_t kLength = 256;
  std::array<char, kLength> picture_{"picture.png"}, solution_{"solution.dlx"}, session_{"session.json"};
  std::shared_ptr<Outcome> outcome_ = std::make_shared<Outcome>();  // may outlive the panel on the solver's thread
};

}  // namespace deltalux::viewer
