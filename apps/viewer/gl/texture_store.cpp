#include "gl/texture_store.hpp"

namespace deltalux::viewer::gl {

GLuint TextureStore::texture(const Scene& scene, TextureId id, std::uint64_t& uploaded) {
  const auto [place, isNew] = textures_.try_emplace(id);
  Texture2D& t = place->second;
  if (isNew) {
    const Texture& source = scene.textures[id.index()];
    t.assign(kRgb32F, source.width, source.height, source.texels.data(), uploaded);
    t.setWrap(GL_REPEAT, GL_REPEAT);
    t.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 1000);
    glGenerateMipmap(GL_TEXTURE_2D);
  }
  return t.name();
}

}  // namespace deltalux::viewer::gl
