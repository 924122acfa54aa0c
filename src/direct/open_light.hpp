#pragma once
// What a light would bring to a point, were nothing in its way.
#include <optional>

#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray.hpp"

namespace deltalux::direct {

struct OpenLight {
  Rgb E{0.0f};  // [W/m2]
  std::optional<scene::LightSample> sample;

  /// Of what shines there: to the light.
  tracing::Ray ray(const hierarchy::PatchPoint&) const;
};

/// By one sample.
OpenLight openLight(const scene::LightSampler&, LightId, const hierarchy::PatchPoint&, const UnitPair&);

}  // namespace deltalux::direct
