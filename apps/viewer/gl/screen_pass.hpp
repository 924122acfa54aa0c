#pragma once
// From light to the screen: layers, tone mapping or false colour, the outline of what is selected.
#include <map>

#include "drawing.hpp"
#include "gl/layers.hpp"
#include "gl/targets.hpp"

namespace deltalux::viewer::gl {

class ScreenPass {
 public:
  ScreenPass();
  /// Into targets.screen. Returns the bytes uploaded.
  std::uint64_t draw(Targets&, Layers&, const DrawSettings&, double luminousEfficacy, int wipe);
  /// Radiance with the layers, as it was drawn last.
  std::vector<glm::vec4> readRadiance(Targets&, Layers&, int wipe);
  /// What is outlined from now on. Returns the bytes uploaded.
  std::uint64_t select(const std::vector<PrimitiveId>&, std::size_t primitives);
  /// Into targets.screen, within the scissor.
  void outline(Targets&);

 private:
  const Program& use(const std::string& parts, Targets&, Layers&, int wipe);

  std::map<std::string, Program> programs_;  // by the names of their parts
  VertexArray none_;
  Texture2D ramp_, levels_, composed_;
  std::vector<float> levelValues_;
  BufferTexture selected_;
  std::vector<float> selection_;
};

}  // namespace deltalux::viewer::gl
