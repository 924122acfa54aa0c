#pragma once
// Irradiance of the leaf patches, the input of reconstruction.
#include <span>

#include "caustics/caustics.hpp"
#include "hierarchy/element.hpp"

namespace deltalux::rendering {

struct LeafIrradiance {
  Rgb direct{0.0f};    // from emitters [W/m2]
  Rgb indirect{0.0f};  // from other surfaces, particles included [W/m2]
  float noise = 0;     // standard deviation, gray [W/m2]
  Rgb particle{0.0f};  // of indirect, what particles brought [W/m2]

  bool operator==(const LeafIrradiance&) const = default;
};

/// `deviation`: by receiving leaf, or none. What push-pull left at every element; without the particles' light where
/// caustic textures show that.
std::vector<LeafIrradiance> meshIrradiance(const hierarchy::Elements&, const caustics::Caustics&,
                                           std::span<const float> deviation);

}  // namespace deltalux::rendering
