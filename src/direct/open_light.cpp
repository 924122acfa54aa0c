#include "direct/open_light.hpp"

#include "tracing/shadow_ray.hpp"

namespace deltalux::direct {

tracing::Ray OpenLight::ray(const hierarchy::PatchPoint& x) const {
  return tracing::shadowRay(Vec3(x.position), Vec3(x.normal), sample->direction, sample->distance, sample->normal);
}

OpenLight openLight(const scene::LightSampler& sampler, LightId id, const hierarchy::PatchPoint& x, const UnitPair& u) {
  OpenLight light{Rgb(0.0f), sampler.sample(id, Vec3(x.position), {u.x, u.y})};
  if (!light.sample) return light;
  const double cosine = glm::dot(light.sample->direction, Vec3(x.normal)), pdf = light.sample->pdf;
  if (cosine > 0) light.E = light.sample->radiance * static_cast<float>(cosine / (pdf > 0 ? pdf : 1.0));
  return light;
}

}  // namespace deltalux::direct
