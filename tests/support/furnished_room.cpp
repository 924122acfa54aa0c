#include "support/furnished_room.hpp"

#include "support/rooms.hpp"

namespace deltalux::test {

namespace {

void nameFrom(Scene& scene, std::size_t first, const char* object) {
  const ObjectId id = internObject(scene, object, '.');
  for (std::size_t i = first; i < scene.primitives.size(); ++i) scene.primitives[i].object = id;
}

}  // namespace

Scene furnishedRoom() {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.6f));
  const MaterialId wood = addMaterial(scene, "wood", lambert(0.4f));
  const MaterialId brass =
      addMaterial(scene, "brass", Opaque{Rgb(0.2f, 0.15f, 0.05f), {}, {Rgb(0.6f, 0.5f, 0.2f), 0.15f, {}}});
  const MaterialId glass = addMaterial(scene, "glass", Dielectric{Rgb(0.95f), 1.5f});
  const MaterialId silver = addMaterial(scene, "silver", Mirror{Rgb(0.85f)});
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0.0f), Emission{Rgb(12.0f), false, {}});
  const auto next = [&] { return scene.primitives.size(); };
  addBox(scene, white, {0, 0, 0}, {3, 4, 2.5}, true);
  nameFrom(scene, 0, "walls");
  std::size_t first = next();
  addBox(scene, wood, {1.0, 1.2, 0.7}, {2.0, 2.2, 0.75}, false);
  for (const double x : {1.02, 1.9})
    for (const double y : {1.22, 2.1}) addBox(scene, wood, {x, y, 0}, {x + 0.08, y + 0.08, 0.7}, false);
  nameFrom(scene, first, "table");
  first = next();
  addBox(scene, wood, {2.2, 0.4, 0}, {2.7, 0.9, 0.5}, false);
  nameFrom(scene, first, "box");
  first = next();
  addShape(scene, brass, Cylinder{{1.3, 1.5, 0.75}, {1.3, 1.5, 0.95}, 0.1, false});
  nameFrom(scene, first, "pot");
  first = next();
  addShape(scene, glass, Sphere{{1.7, 1.8, 0.86}, 0.1, false});
  nameFrom(scene, first, "ball");
  first = next();
  addPolygon(scene, silver, {{0.02, 1, 1}, {0.02, 1.8, 1}, {0.02, 1.8, 1.8}, {0.02, 1, 1.8}});
  nameFrom(scene, first, "mirror");
  first = next();
  addShape(scene, lamp, Sphere{{2.4, 3.2, 1.8}, 0.12, false});
  nameFrom(scene, first, "globe");
  addAreaLights(scene);
  scene.lights.back().name = "globe";
  SpotLight spot;
  spot.position = {0.8, 1.0, 2.3}, spot.direction = {0, 0, -1};
  spot.cosInner = 0.9, spot.cosOuter = 0.7, spot.intensity = Rgb(4.0f);
  scene.lights.push_back({"spot", spot, Rgb(1.0f)});
  return scene;
}

Editable editableOfFurnishedRoom() {
  return {{"table", "box", "pot", "ball", "mirror", "globe"},
          {"globe", "spot"},
          {"spot"},
          {"white", "wood", "brass", "silver"},
          {"brass"},
          0.25};
}

}  // namespace deltalux::test
