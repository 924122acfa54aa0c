#pragma once
// What lines do where they meet a surface: they end on its leaf in proportion to what it does diffusely, go on by its
// specular part, or pass straight on, as shadow rays do. The chances of a material are the same at every angle, so that
// a line's chance is the same from either of its ends; panes, on which no line ends, part it by Fresnel's law.
#include <deltalux/scene.hpp>
#include <vector>

#include "scene/bsdf.hpp"

namespace deltalux::lines {

struct SurfaceResponse {
  scene::Bsdf specular;  // neither diffuse parts nor passage
  Rgb passage{0.0f};     // what goes straight on beside what is covered
  float ends = 1;        // chance that a line ends here
  float passes = 0;      // chance that it goes straight on; the rest goes on by the specular part
  bool pane = false;
  const Dielectric* body = nullptr;  // behind the front
};

class SurfaceResponses {
 public:
  /// The scene must outlive this. Without `speculars` panes pass light straight on and nothing else goes on.
  SurfaceResponses(const Scene&, bool speculars);

  const SurfaceResponse& at(PrimitiveId primitive, bool front) const {
    return all_[2 * scene_[primitive].material.index() + (front ? 1 : 0)];
  }
  bool speculars() const { return speculars_; }
  /// By material: whether lines end on it and do nothing else, so that its colour changes none of them.
  std::vector<char> plain() const;

 private:
  const Scene& scene_;
  bool speculars_;
  std::vector<SurfaceResponse> all_;  // by material: back, front
};

}  // namespace deltalux::lines
