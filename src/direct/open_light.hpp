#pragma once
// What a light would bring to a point, were nothing in its way.
#include <optional>

#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::direct {

struct OpenLight {
  Rgb E{0.0f};  // [W/m2]
  std::optional<scene::LightSample> sample;

  /// Of what shines there: to the light.
  tracing::Ray ray(const hierarchy::PatchPoint& x) const {
    return tracing::shadowRay(Vec3(x.position), Vec3(x.normal), sample->direction, sample->distance, sample->normal);
  }
};

/// By one sample.
inline OpenLight openLight(const scene::LightSampler& sampler, LightId id, const hierarchy::PatchPoint& x,
                           const UnitPair& u) {
  OpenLight light{Rgb(0.0f), sampler.sample(id, Vec3(x.position), {u.x, u.y})};
  if (!light.sample) return light;
  const double cosine = glm::dot(light.sample->direction, Vec3(x.normal)), pdf = light.sample->pdf;
  if (cosine > 0) light.E = light.sample->radiance * static_cast<float>(cosine / (pdf > 0 ? pdf : 1.0));
  return light;
}

}  // namespace deltalux::direct
