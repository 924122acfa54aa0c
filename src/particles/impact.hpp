#pragma once
// Where particles land: the light that reached a diffuse surface by way of mirrors, gloss or glass, as points.
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::particles {

/// One deposit of one particle.
struct Impact {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;  // of a mesh
  bool front = true;           // the side that it arrived at
  glm::vec2 uv{0.0f};          // parameters of the primitive; on a mesh of its triangle: p0 + u (p1 - p0) + v (p2 - p0)
  Rgb flux{0.0f};              // that arrives here [W, with the scene's unit squared as area]
};

struct Particles;

/// Every impact with today's flux, that is, with the radiosity that its particle's sender has now; in the order of the
/// particles, which does not depend on the number of threads.
std::vector<Impact> impacts(const Particles&, const hierarchy::Elements&, const Scene&);
/// The same at these scales of lights.
std::vector<Impact> impacts(const Particles&, const hierarchy::Elements&, const Scene&, std::span<const Rgb> scales);

}  // namespace deltalux::particles
