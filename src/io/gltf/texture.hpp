#pragma once
// Images of a glTF file, decoded when a material asks for them.
#include <array>
#include <deltalux/scene.hpp>
#include <map>
#include <utility>

#include "io/gltf/document.hpp"
#include "io/import_texture.hpp"

namespace deltalux::io {

/// Reads every image once per encoding; puts those that surfaces show into the scene.
class GltfTextures {
 public:
  explicit GltfTextures(const GltfDocument& document) : document_(document) {}

  /// The mean texel of texture `index`. Throws InputError when it cannot be read.
  Rgb average(int index, TexelEncoding);
  /// How many texels, as a share, have each of 256 alphas. Throws InputError when it cannot be read.
  const std::array<double, 256>& alphas(int index);
  /// Texture `index` in `scene`, sRGB decoded. Throws InputError when it cannot be read.
  TextureId put(int index, Scene&);

 private:
  struct Decoded {
    Texture texture;  // empty once it is in the scene
    Rgb average{0.0f};
  };
  int imageOf(int texture) const;
  /// visit(its bytes) of an image, which gives what it is as an optional.
  template <class Visit>
  auto read(int image, const Visit& visit) const;
  Decoded& decoded(int image, TexelEncoding);

  const GltfDocument& document_;
  std::map<std::pair<int, TexelEncoding>, Decoded> decoded_;
  std::map<int, std::array<double, 256>> alphas_;  // by image
  std::map<int, TextureId> placed_;
};

}  // namespace deltalux::io
