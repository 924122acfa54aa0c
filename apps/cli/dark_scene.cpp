#include "dark_scene.hpp"

#include <algorithm>

namespace deltalux::cli {

namespace {

struct Shines {
  const Scene& scene;

  bool operator()(const AreaLight& light) const {
    const auto& emission = scene.materialOf(light.primitive).emission;
    return emission && !isBlack(emission->radiance);
  }
  bool operator()(const PointLight& light) const { return !isBlack(light.intensity); }
  bool operator()(const SpotLight& light) const { return !isBlack(light.intensity); }
  bool operator()(const LambertPointLight& light) const { return !isBlack(light.intensity); }
  bool operator()(const PhotometricLight& light) const {
    return !isBlack(light.scale) && luminousFlux(*light.photometry) > 0;
  }
  bool operator()(const SunLight& light) const { return !isBlack(light.radiance); }
  bool operator()(const DomeLight& light) const { return !isBlack(light.scale); }
};

}  // namespace

void warnIfDark(const Scene& scene, const Run& run) {
  const bool shines = std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    return !isBlack(light.scale) && std::visit(Shines{scene}, light.emitter);
  });
  if (!shines)
    run.say(
        "warning: the scene has no light: all of it is black; add a lamp, a sky or a material that emits (--ies hangs "
        "a measured lamp)");
}

}  // namespace deltalux::cli
