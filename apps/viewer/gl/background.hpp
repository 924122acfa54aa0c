#pragma once
// What is seen where no surface is: domes and backdrops from a table by direction, which is made again when they
// change; suns as discs.
#include <deltalux/scene.hpp>

#include "gl/objects.hpp"
#include "gl/projection.hpp"

namespace deltalux::viewer::gl {

class Background {
 public:
  Background();
  /// Returns the bytes that were uploaded.
  std::uint64_t update(const Scene&);
  /// Over colour 0 where depth is that of nothing.
  void draw(const Eye&, int width, int height);

 private:
  struct Dome {
    DomeLight light;
    Rgb scale{1.0f};

    bool operator==(const Dome&) const = default;
  };
  struct Sun {
    glm::vec4 directionAndChord{0.0f};
    glm::vec3 radiance{0.0f};
  };

  bool dark() const { return domes_.empty() && suns_.empty(); }

  std::vector<Dome> domes_;
  std::vector<Sun> suns_;
  Texture2D sky_;
  Program program_;
  VertexArray none_;
};

}  // namespace deltalux::viewer::gl
