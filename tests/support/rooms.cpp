#include "support/rooms.hpp"

#include <utility>

namespace deltalux::test {

MaterialId addMaterial(Scene& scene, std::string name, Surface surface, std::optional<Emission> emission) {
  scene.materials.push_back({std::move(name), std::move(surface), std::move(emission)});
  return MaterialId(scene.materials.size() - 1);
}

Opaque lambert(float reflectance) {
  Opaque opaque;
  opaque.diffuse = Rgb(reflectance);
  return opaque;
}

PrimitiveId addShape(Scene& scene, MaterialId material, Shape shape) {
  if (scene.objects.empty()) scene.objects.push_back({"scene", ObjectId()});
  scene.primitives.push_back({std::move(shape), material, ObjectId(0)});
  return PrimitiveId(scene.primitives.size() - 1);
}

PrimitiveId addPolygon(Scene& scene, MaterialId material, std::vector<Vec3> vertices) {
  return addShape(scene, material, makePolygon(std::move(vertices)).value());
}

void addBox(Scene& scene, MaterialId material, const Vec3& lower, const Vec3& upper, bool inward) {
  const auto corner = [&](int i) {
    return Vec3(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z);
  };
  // Counter-clockwise seen from outside.
  constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    std::vector<Vec3> vertices{corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])};
    if (inward) std::swap(vertices[1], vertices[3]);
    addPolygon(scene, material, std::move(vertices));
  }
}

void addBlock(Scene& scene, std::string name, MaterialId material, const Vec3& lower, const Vec3& upper) {
  const ObjectId block(scene.objects.size());
  scene.objects.push_back({std::move(name), ObjectId(0)});
  const std::size_t first = scene.primitives.size();
  addBox(scene, material, lower, upper, false);
  for (std::size_t i = first; i < scene.primitives.size(); ++i) scene.primitives[i].object = block;
}

void addLight(Scene& scene, decltype(Light::emitter) emitter) {
  scene.lights.push_back({"light" + std::to_string(scene.lights.size()), std::move(emitter), Rgb(1.0f)});
}

}  // namespace deltalux::test
