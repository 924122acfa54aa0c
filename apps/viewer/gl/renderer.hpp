#pragma once
// Draws frames with OpenGL 3.3 [GD01 6.1]: the smooth mesh, then caustic textures, depth writes off, blended
// additively, both times what the surface reflects (surface_passes.hpp says why in this order); what stands behind
// glass, times what the glass passes; then the Render Cache's pixels where the first surface is a mirror, gloss or
// glass, the picture that is made better at rest, tone mapping or false colour, outlines and lines. Uploads what has
// changed since the snapshot before, and nothing else.
#include <memory>

#include "drawing.hpp"

namespace deltalux::viewer::gl {

class Renderer {
 public:
  /// A context of OpenGL 3.3 core must be current, here and in every call. Throws std::runtime_error that says what is
  /// missing.
  Renderer();
  ~Renderer();

  /// Draws into the framebuffer that is bound, at the viewport's place (0, 0, width, height). `cache`: projected and
  /// filled by the way, null for none. Waits for GL to finish only where statistics are shown: otherwise
  /// `milliseconds` are those of giving the commands. Without a mesh nothing is drawn.
  DrawReport draw(const Frame&, RenderCache* cache);
  /// Pixels of the frame drawn last, without what panels draw over it.
  DisplayImage screenshot() const;
  /// Radiance of the same, before tone mapping [W/(sr m2)].
  Image radiance() const;
  /// By pixel: the primitive seen first, as value + 1; 0: none. Row by row from the top.
  const std::vector<std::uint32_t>& surfaces() const;
  /// By pixel, 1 where the first surface has a mirror, gloss or glass.
  std::vector<char> specularPixels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux::viewer::gl
