#pragma once
// Irradiance of the leaf patches, the input of reconstruction.
#include "caustics/caustics.hpp"
#include "hierarchy/element.hpp"

namespace deltalux {

struct LeafIrradiance {
  Rgb direct{0.0f};    // from emitters [W/m2]
  Rgb indirect{0.0f};  // from other surfaces, particles included [W/m2]
};

/// What push-pull left at every element; without the particles' light where caustic textures show that.
inline std::vector<LeafIrradiance> meshIrradiance(const Elements& elements, const Caustics& caustics) {
  std::vector<LeafIrradiance> values(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementLight& l = elements.radiometry[i];
    const bool textured = elements.isPatch(ElementId(i)) && elements.domain[i].primitive.valid() &&
                          caustics.of(elements.domain[i].primitive, elements.topology[i].front) != nullptr;
    values[i] = {l.direct, textured ? l.indirect : l.indirect + l.particle};
  }
  return values;
}

}  // namespace deltalux
