#pragma once
// Irradiance of the leaf patches, the input of reconstruction.
#include "hierarchy/element.hpp"

namespace deltalux {

struct LeafIrradiance {
  Rgb direct{0.0f};    // from emitters [W/m2]
  Rgb indirect{0.0f};  // from other surfaces, particles included [W/m2]
};

inline bool isReceivingLeaf(const Elements& elements, ElementId e) {
  const ElementTopology& t = elements.at(e);
  return t.kind == ElementKind::Patch && t.childCount == 0 && !t.emitter && !t.blocker;
}

/// What push-pull left at every element.
inline std::vector<LeafIrradiance> meshIrradiance(const Elements& elements) {
  std::vector<LeafIrradiance> values(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementLight& l = elements.radiometry[i];
    values[i] = {l.direct, l.indirect + l.particle};
  }
  return values;
}

}  // namespace deltalux
