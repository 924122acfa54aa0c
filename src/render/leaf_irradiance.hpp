#pragma once
// Irradiance of the leaf patches, the input of reconstruction.
#include <span>

#include "caustics/caustics.hpp"
#include "hierarchy/element.hpp"
#include "radiosity/leaf_transfers.hpp"

namespace deltalux::rendering {

struct LeafIrradiance {
  Rgb direct{0.0f};    // from emitters [W/m2]
  Rgb indirect{0.0f};  // from other surfaces, particles included [W/m2]
  float noise = 0;     // standard deviation of indirect, gray: that of the rays of its row [W/m2]
  Rgb particle{0.0f};  // of indirect, what particles brought [W/m2]

  bool operator==(const LeafIrradiance&) const = default;
};

/// `deviation`: by receiving leaf, where light is exchanged by lines. What push-pull left at every element; without the
/// particles' light where caustic textures show that.
std::vector<LeafIrradiance> meshIrradiance(const hierarchy::Elements&, const caustics::Caustics&,
                                           const radiosity::LeafTransfers&, std::span<const float> deviation);

}  // namespace deltalux::rendering
