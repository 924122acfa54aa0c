#include "scene/diffuse_only.hpp"

namespace deltalux::scene {

namespace {
void drop(Opaque& s) { s.specular.reflectance = Rgb(0.0f); }
void drop(Trans& s) { s.reflection.reflectance = s.transmission.reflectance = Rgb(0.0f); }
void drop(ThinGlass&) {}
}  // namespace

void dropSpeculars(Scene& scene) {
  for (Material& m : scene.materials) {
    if (std::holds_alternative<Mirror>(m.surface) || std::holds_alternative<Dielectric>(m.surface)) {
      m.surface = Opaque{};
      continue;
    }
    std::visit(
        [](auto& s) {
          if constexpr (requires { drop(s); }) drop(s);
        },
        m.surface);
  }
}

}  // namespace deltalux::scene
