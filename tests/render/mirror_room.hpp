#pragma once
// A diffuse room with a flat mirror for a wall, a lamp and a block that can be moved.
#include <deltalux/pixel_sample.hpp>
#include <deltalux/view.hpp>

#include "support/solved.hpp"

namespace deltalux::test {

inline Scene mirrorRoom() {
  Scene scene;
  const MaterialId wall = addMaterial(scene, "wall", lambert(0.5f));
  addBox(scene, wall, {0, 0, 0}, {2, 2, 2}, true);
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
             {{0.2, 1.99, 0.2}, {1.8, 1.99, 0.2}, {1.8, 1.99, 1.8}, {0.2, 1.99, 1.8}});
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(10.0f), false, std::nullopt}),
             {{0.7, 0.7, 1.98}, {0.7, 1.3, 1.98}, {1.3, 1.3, 1.98}, {1.3, 0.7, 1.98}});
  const std::size_t block = scene.primitives.size();
  addBox(scene, addMaterial(scene, "red", Opaque{Rgb(0.6f, 0.2f, 0.1f), {}, {}}), {0.3, 0.9, 0.3}, {0.5, 1.1, 0.5},
         false);
  const ObjectId object = internObject(scene, "block", '.');
  for (std::size_t p = block; p < scene.primitives.size(); ++p) scene.primitives[p].object = object;
  addAreaLights(scene);
  return scene;
}
inline constexpr std::uint32_t kRoomMirror = 6;  // the primitive

/// Along the room, towards the mirror.
inline View towardsMirror() {
  View view;
  view.position = {1.0, 0.1, 1.1}, view.direction = {0, 1, -0.15}, view.horizontal = view.vertical = 75;
  return view;
}

/// One ray through the middle of each pixel.
inline std::vector<PixelRay> raysOf(const View& view, int width, int height) {
  std::vector<PixelRay> rays;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const ViewRay from = viewRay(view, (x + 0.5) / width, (y + 0.5) / height);
      rays.push_back({Vec3f(from.origin), Vec3f(from.direction), static_cast<std::uint32_t>(y * width + x), 0});
    }
  return rays;
}

}  // namespace deltalux::test
