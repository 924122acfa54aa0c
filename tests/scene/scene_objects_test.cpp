#include <gtest/gtest.h>
#include <deltalux/scene.hpp>

#include "scene/object_index.hpp"

namespace deltalux {
using namespace scene;

namespace {

Scene threeSpheres() {
  Scene scene;
  scene.materials = {{"grey", Opaque{Rgb(0.5f), {}, {}}, {}}, {"lamp", Opaque{}, Emission{Rgb(3.0f), false, {}}}};
  for (const char* name : {"dresser.drawer.0", "dresser.drawer.1", "dresser2"}) {
    const ObjectId object = internObject(scene, name, '.');
    scene.primitives.push_back({Sphere{}, MaterialId(0), object});
  }
  return scene;
}

TEST(InternObject, MakesEveryPrefixOnceWithItsParent) {
  Scene scene = threeSpheres();
  ASSERT_EQ(scene.objects.size(), 5u);  // dresser, dresser.drawer, .0, .1, dresser2
  const ObjectId drawer = internObject(scene, "dresser.drawer", '.');
  EXPECT_EQ(scene.objects.size(), 5u);
  EXPECT_EQ(scene[scene[drawer].parent].name, "dresser");
  EXPECT_FALSE(scene[scene[drawer].parent].parent.valid());
}

TEST(InternObject, EmptyPartsMakeNoObjectOfTheirOwn) {
  Scene scene;
  internObject(scene, ".a..b.", '.');
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, ".a");
  EXPECT_EQ(scene.objects[1].name, ".a..b.");
}

TEST(ObjectIndex, AgreesWithInternObject) {
  Scene searched, indexed;
  ObjectIndex index(indexed);
  for (const char* name : {"a.b.c", "a.b", "a.bc", "x", "a.b.c.d", "x"}) {
    EXPECT_EQ(internObject(searched, name, '.'), index.intern(name, '.')) << name;
  }
  ASSERT_EQ(searched.objects.size(), indexed.objects.size());
  for (std::size_t i = 0; i < searched.objects.size(); ++i) {
    EXPECT_EQ(searched.objects[i].name, indexed.objects[i].name);
    EXPECT_EQ(searched.objects[i].parent, indexed.objects[i].parent);
  }
}

TEST(FindObjects, ByFullNameElseByLastPathPart) {
  Scene scene;
  internObject(scene, "house/kitchen/lamp", '/');
  internObject(scene, "house/cellar/lamp", '/');
  internObject(scene, "chair", '/');
  EXPECT_EQ(findObjects(scene, "lamp").size(), 2u);
  EXPECT_EQ(findObjects(scene, "house/cellar/lamp").size(), 1u);
  EXPECT_EQ(findObjects(scene, "chair").size(), 1u);
  EXPECT_TRUE(findObjects(scene, "stool").empty());
}

TEST(PrimitivesOf, TakesTheObjectAndAllBelowButNoNamesakes) {
  const Scene scene = threeSpheres();
  const auto objects = findObjects(scene, "dresser");
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(primitivesOf(scene, objects[0]), (std::vector<PrimitiveId>{PrimitiveId(0), PrimitiveId(1)}));
}

TEST(FindLights, ByNameAndByPrefix) {
  Scene scene;
  for (const char* name : {"lamp", "lamp.0", "lamp2", "sun"}) scene.lights.push_back({name, PointLight{}, Rgb(1.0f)});
  EXPECT_EQ(findLights(scene, "lamp"), (std::vector<LightId>{LightId(0), LightId(1)}));
  EXPECT_TRUE(findLights(scene, "moon").empty());
}

TEST(NearMisses, NearestFirstWithoutRepeats) {
  const auto found = nearMisses("dreser", {"bed", "dresser", "dresser", "wardrobe", "dress"}, 2);
  EXPECT_EQ(found, (std::vector<std::string>{"dresser", "dress"}));
}

TEST(AddAreaLights, ListsEachEmitterOnceUnderItsObjectsName) {
  Scene scene = threeSpheres();
  scene.primitives[1].material = MaterialId(1);
  addAreaLights(scene);
  addAreaLights(scene);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "dresser.drawer.1");
  EXPECT_EQ(std::get<AreaLight>(scene.lights[0].emitter).primitive, PrimitiveId(1));
}

TEST(Validate, FindsWhatDoesNotHold) {
  EXPECT_NO_THROW(validate(threeSpheres()));
  const auto broken = [](auto&& damage) {
    Scene scene = threeSpheres();
    damage(scene);
    EXPECT_THROW(validate(scene), std::logic_error);
  };
  broken([](Scene& s) { s.primitives[0].material = MaterialId(7); });
  broken([](Scene& s) { s.primitives[0].object = ObjectId(7); });
  broken([](Scene& s) { std::get<Sphere>(s.primitives[0].shape).radius = -1; });
  broken([](Scene& s) { std::get<Sphere>(s.primitives[0].shape).center.x = kInfinity; });
  broken([](Scene& s) { std::get<Opaque>(s.materials[0].surface).diffuse = Rgb(1.5f); });
  broken([](Scene& s) { s.materials[0].coverage = 1.01f; });
  broken([](Scene& s) { s.materials[0].coverage = -0.01f; });
  broken([](Scene& s) { s.materials[0].filter = Rgb(0.5f, 1.5f, 0.5f); });
  broken([](Scene& s) { s.materials[0].surface = Dielectric{}, s.materials[0].coverage = 0.5f; });
  broken([](Scene& s) { std::get<Opaque>(s.materials[0].surface).specular.reflectance = Rgb(0.6f); });
  broken([](Scene& s) { s.objects[0].parent = ObjectId(1); });
  broken([](Scene& s) { s.lights.push_back({"l", AreaLight{PrimitiveId(0)}, Rgb(1.0f)}); });
  broken([](Scene& s) { s.lights.push_back({"l", SunLight{Vec3(2, 0, 0), 0.004, Rgb(1.0f)}, Rgb(1.0f)}); });
  broken([](Scene& s) { s.metresPerUnit = 0; });
}

TEST(Texture, SamplesBilinearlyAndRepeats) {
  const Texture texture{"checker", 2, 1, {Rgb(0.0f), Rgb(1.0f)}};
  EXPECT_FLOAT_EQ(texture.sample({0.25, 0.5}).r, 0.0f);
  EXPECT_FLOAT_EQ(texture.sample({0.75, 0.5}).r, 1.0f);
  EXPECT_FLOAT_EQ(texture.sample({0.5, 0.9}).r, 0.5f);
  EXPECT_FLOAT_EQ(texture.sample({0.0, 0.1}).r, 0.5f);    // between the last texel and the first
  EXPECT_FLOAT_EQ(texture.sample({-7.25, 3.0}).r, 1.0f);  // -7.25 repeats as 0.75
}

}  // namespace
}  // namespace deltalux
