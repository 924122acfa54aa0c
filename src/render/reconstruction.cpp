#include "render/reconstruction.hpp"

#include "render/leaf_gather.hpp"
#include "solution/solution.hpp"

namespace deltalux {

Reconstruction::Reconstruction(const Solution& s)
    : locator(s.elements, s.scene),
      field(s.elements, s.scene, *s.tracer, gatherAtLeaves(s)),
      direct(s),
      choices(direct, s.elements.size()) {}

}  // namespace deltalux
