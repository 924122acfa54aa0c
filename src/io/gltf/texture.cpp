#include "io/gltf/texture.hpp"

#include <deltalux/error.hpp>

namespace deltalux::io {

int GltfTextures::imageOf(int texture) const {
  const int image = document_.model.textures[static_cast<std::size_t>(texture)].source;
  if (image < 0) {
    const auto& extensions = document_.model.textures[static_cast<std::size_t>(texture)].extensions;
    const std::string lack = extensions.empty()
                                 ? " has no PNG or JPEG image"
                                 : " needs " + extensions.begin()->first.substr(0, 60) + ", which is not read";
    throw InputError(document_.name, 0, "/textures/" + std::to_string(texture) + lack,
                     "export the scene with PNG or JPEG textures");
  }
  return image;
}

template <class Visit>
auto GltfTextures::read(int image, const Visit& visit) const {
  const std::string where = "/images/" + std::to_string(image);
  const GltfImage& source = document_.images[static_cast<std::size_t>(image)];
  std::string read;
  if (source.bufferView < 0) read = bytesOfUri(document_.name, document_.folder, source.uri, where);
  auto result = visit(source.bufferView < 0 ? std::string_view(read) : bytesOfView(document_, source.bufferView));
  if (!result) {
    throw InputError(document_.name, 0, where + " is no PNG or JPEG image, or larger than 64 million texels",
                     "export the scene with smaller PNG or JPEG textures");
  }
  return std::move(*result);
}

GltfTextures::Decoded& GltfTextures::decoded(int image, TexelEncoding encoding) {
  const auto known = decoded_.find({image, encoding});
  if (known != decoded_.end()) return known->second;
  Texture texture = read(image, [&](std::string_view bytes) {
    return decodeTexture(bytes, "/images/" + std::to_string(image), encoding);
  });
  const Rgb mean = deltalux::io::average(texture);
  return decoded_.emplace(std::pair(image, encoding), Decoded{std::move(texture), mean}).first->second;
}

const std::array<double, 256>& GltfTextures::alphas(int index) {
  const int image = imageOf(index);
  const auto known = alphas_.find(image);
  return known != alphas_.end() ? known->second : alphas_.emplace(image, read(image, alphaShares)).first->second;
}

Rgb GltfTextures::average(int index, TexelEncoding encoding) { return decoded(imageOf(index), encoding).average; }

TextureId GltfTextures::put(int index, Scene& scene) {
  const int image = imageOf(index);
  const auto [entry, isNew] = placed_.try_emplace(image, TextureId(scene.textures.size()));
  if (isNew) scene.textures.push_back(std::move(decoded(image, TexelEncoding::Srgb).texture));
  return entry->second;
}

}  // namespace deltalux::io
