#pragma once
// From light to the screen: layers, tone mapping or false colour, the outline of what is selected.
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

 private:
  void bindLayers(const Program&, Targets&, Layers&, int wipe);

  Program show_, compose_;
  VertexArray none_;
  Texture2D ramp_, levels_, composed_;
  std::vector<float> levelValues_;
  BufferTexture selected_;
  std::vector<float> selection_;
};

}  // namespace deltalux::viewer::gl
