#include "render/reconstruction.hpp"

#include "solution/solution.hpp"

namespace deltalux::rendering {

Reconstruction::Reconstruction(const Solution& s, const Reconstruction* before, float tolerance)
    : locator(s.elements, s.scene),
      field(s.elements, s.scene, *s.tracer, meshIrradiance(s.elements, s.caustics, s.deviation),
            static_cast<float>(s.settings.error), before ? &before->field : nullptr, tolerance),
      sources(s) {}

}  // namespace deltalux::rendering
