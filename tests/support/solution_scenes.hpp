#pragma once
// A small scene with one of everything that a scene can hold.
#include <deltalux/scene.hpp>

#include "support/rooms.hpp"

namespace deltalux::test {

inline Texture checker() {
  Texture texture{"checker", 2, 2, {}};
  for (const float value : {0.2f, 0.9f, 0.9f, 0.2f}) texture.texels.push_back(Rgb(value, 0.8f * value, 0.5f));
  return texture;
}

/// A measured distribution that favours one side.
inline std::shared_ptr<const Photometry> lopsided() {
  Photometry p{{0, 90, 180}, {0, 180, 360}, {}, Vec3(0.1, 0.2, 0)};
  p.candela = {300, 100, 0, 300, 20, 0, 300, 100, 0};
  return std::make_shared<const Photometry>(std::move(p));
}

/// Brighter towards +z than towards -z.
inline std::shared_ptr<const DirectionTable> upwards() {
  static const auto table = std::make_shared<const DirectionTable>(DirectionTable{3, 2, {2, 2, 1, 1.5f, 0.5f, 0.5f}});
  return table;
}

inline void addEveryShape(Scene& scene) {
  const MaterialId white = addMaterial(scene, "white", lambert(0.7f));
  const MaterialId brass =
      addMaterial(scene, "brass", Opaque{Rgb(0.2f, 0.15f, 0.05f), {}, {Rgb(0.6f, 0.5f, 0.2f), 0.1f, {}}});
  const MaterialId glass = addMaterial(scene, "pane", ThinGlass{Rgb(0.9f), 1.52f});
  const MaterialId paper = addMaterial(scene, "paper", Trans{Rgb(0.3f), Rgb(0.4f), {}, {}});
  const MaterialId water = addMaterial(scene, "water", Dielectric{Rgb(0.9f, 0.95f, 1.0f), 1.33f});
  const MaterialId mirror = addMaterial(scene, "mirror", Mirror{Rgb(0.8f)});
  scene.textures.push_back(checker());
  const MaterialId tiles = addMaterial(scene, "tiles", Opaque{Rgb(0.9f), TextureId(0), {}});
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0),
                                      Emission{Rgb(20.0f, 18.0f, 12.0f), false, SpotCone{1.5, {0, 0, -1}},
                                               EmissionPattern{upwards(), glm::dmat3(1.0), 0.8, Vec3(0, 0, -1)}});

  addBox(scene, white, Vec3(0), Vec3(3, 2, 2), true);
  scene.primitives.pop_back();  // one wall is open to the sky
  addPolygon(scene, glass, {{0, 2, 0}, {3, 2, 0}, {3, 2, 1}, {0, 2, 1}});
  addPolygon(scene, paper, {{0.2, 1, 1}, {0.8, 1, 1}, {0.8, 1, 1.5}});
  addShape(scene, white, Sphere{{1, 0.6, 0.3}, 0.3, false});
  addShape(scene, brass, Cylinder{{2, 0.5, 0}, {2, 0.5, 0.5}, 0.2, false});
  addShape(scene, mirror, Cone{{2.5, 1.2, 0}, {2.5, 1.2, 0.6}, 0.3, 0.1, true});
  addShape(scene, water, Sphere{{0.5, 1.4, 0.2}, 0.15, false});
  addShape(scene, lamp, Ring{{1.5, 1, 1.99}, {0, 0, -1}, 0.1, 0.3});
  addShape(scene, tiles,
           *makeMesh({{0.5, 0.2, 0.8}, {1.5, 0.2, 0.8}, {1.5, 1, 0.9}, {0.5, 1, 0.7}}, {{0, 1, 2}, {0, 2, 3}},
                     {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
}

inline void addEveryLight(Scene& scene) {
  addAreaLights(scene);
  addLight(scene, PointLight{{0.5, 0.5, 1.5}, Rgb(0.5f)});
  addLight(scene, SpotLight{{2.5, 1, 1.9}, {0, 0, -1}, Rgb(3.0f), 0.9, 0.8});
  addLight(scene, LambertPointLight{{1, 1, 1.9}, {0, 0, -1}, Rgb(0.2f)});
  for (const double x : {0.4, 2.6}) {
    PhotometricLight measured;
    measured.position = {x, 1.5, 1.8};
    measured.photometry = std::get_if<PhotometricLight>(&scene.lights.back().emitter)
                              ? std::get<PhotometricLight>(scene.lights.back().emitter).photometry
                              : lopsided();
    addLight(scene, measured);
  }
  addLight(scene, SunLight{glm::normalize(Vec3(0.3, 1, 1)), 0.004654793, Rgb(1e4f, 9e3f, 8e3f)});
  const Vec3 sun = glm::normalize(Vec3(0.3, 1, 1));
  DomeLight sky{
      {0, 0, 1}, kPi / 2, Rgb(0.6f, 0.7f, 0.9f), RadianceSky{RadianceSky::Kind::Clear, 3, 1, 0.5, sun}, {0, 0, 1}};
  addLight(scene, sky);
  sky.distribution = CieSky{12, 0.5, 0.1, sun}, sky.scale = Rgb(0.5f);
  addLight(scene, sky);
  sky.distribution = PerezSky{0.5, 0.1, {-1, -0.3, 5, -2, 0.3}, sun};
  addLight(scene, sky);
  sky.distribution = TabulatedSky{upwards(), glm::dmat3(1.0)};
  addLight(scene, sky);
  addLight(scene, DomeLight{{0, 0, -1}, kPi / 2, Rgb(0.1f), UniformSky{1.5}, {0, 0, 1}});
  scene.lights.back().scale = Rgb(1.0f, 0.5f, 0.25f);
}

inline Scene oneOfEverything() {
  Scene scene;
  scene.metresPerUnit = 0.3048;
  addEveryShape(scene);
  addEveryLight(scene);
  scene.objects.push_back({"scene.part", ObjectId(0)});
  scene.primitives[2].object = ObjectId(1);
  View view{"door", View::Kind::Parallel, {1, 0.2, 1}, {0, 1, 0}, {0, 0, 1}, 3, 2};
  scene.views.push_back(view);
  return scene;
}

}  // namespace deltalux::test
