#include "scene_copies.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

namespace deltalux::bench {

namespace {

constexpr double kGap = 0.05;  // between copies, of their extent

void copyObjects(Scene& to, const Scene& from, int copy, std::uint32_t first) {
  for (Object object : from.objects) {
    object.name = "copy" + std::to_string(copy) + "." + object.name;
    if (object.parent.valid()) object.parent.value += first;
    to.objects.push_back(std::move(object));
  }
}

/// nullopt for what is at infinity, or comes back by addAreaLights.
std::optional<Light> movedLight(const Light& light, const Vec3& offset) {
  return std::visit(
      [&](auto emitter) -> std::optional<Light> {
        if constexpr (requires { emitter.position; }) {
          emitter.position += offset;
          return Light{light.name, emitter, light.scale};
        }
        return std::nullopt;
      },
      light.emitter);
}

}  // namespace

Scene sideBySide(const Scene& scene, int copies) {
  Scene result = scene;
  const Vec3 extent = bounds(scene).extent(), up = glm::abs(scene.up);
  const int alongUp = up.x > 0.5 ? 0 : up.y > 0.5 ? 1 : 2;
  const int first = (alongUp + 1) % 3, second = (alongUp + 2) % 3;
  const int columns = static_cast<int>(std::ceil(std::sqrt(copies)));
  for (int i = 1; i < copies; ++i) {
    Vec3 offset(0);
    offset[first] = (1 + kGap) * extent[first] * (i % columns);
    offset[second] = (1 + kGap) * extent[second] * (i / columns);
    const auto firstObject = static_cast<std::uint32_t>(result.objects.size());
    copyObjects(result, scene, i, firstObject);
    for (Primitive p : scene.primitives) {
      p.shape = transformed(p.shape, glm::translate(Mat4(1.0), offset)).value();
      if (p.object.valid()) p.object.value += firstObject;
      result.primitives.push_back(std::move(p));
    }
    for (const Light& light : scene.lights)
      if (auto moved = movedLight(light, offset)) result.lights.push_back(*std::move(moved));
  }
  addAreaLights(result);
  return result;
}

}  // namespace deltalux::bench
