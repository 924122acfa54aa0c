#pragma once
// The scene's textures on the graphics card, each uploaded when it is first drawn. Edits do not change them.
#include <deltalux/scene.hpp>
#include <map>

#include "gl/objects.hpp"

namespace deltalux::viewer::gl {

class TextureStore {
 public:
  GLuint texture(const Scene&, TextureId, std::uint64_t& uploaded);

 private:
  std::map<TextureId, Texture2D> textures_;
};

}  // namespace deltalux::viewer::gl
