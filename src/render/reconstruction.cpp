#include "render/reconstruction.hpp"

#include "solution/solution.hpp"

namespace deltalux {

Reconstruction::Reconstruction(const Solution& s)
    : locator(s.elements, s.scene),
      field(s.elements, s.scene, *s.tracer, meshIrradiance(s.elements, s.caustics)),
      direct(s.scene, s.elements, s.links, *s.tracer),
      choices(direct, s.elements.size()) {}

}  // namespace deltalux
