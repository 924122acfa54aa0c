#include <deltalux/scene.hpp>

#include "base/check.hpp"
#include "scene/name_prefixes.hpp"

namespace deltalux {

namespace {

ObjectId objectOfName(const Scene& scene, std::string_view name) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].name == name) return ObjectId(i);
  }
  return {};
}

std::string_view lastPathPart(std::string_view path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

}  // namespace

ObjectId internObject(Scene& scene, std::string_view name, char separator) {
  if (const ObjectId known = objectOfName(scene, name); known.valid()) return known;
  ObjectId parent;
  scene::forEachPrefix(name, separator, [&](std::string_view prefix) {
    ObjectId object = objectOfName(scene, prefix);
    if (!object.valid()) {
      object = ObjectId(scene.objects.size());
      scene.objects.push_back({std::string(prefix), parent});
    }
    parent = object;
  });
  return parent;
}

std::vector<ObjectId> findObjects(const Scene& scene, std::string_view name) {
  if (const ObjectId exact = objectOfName(scene, name); exact.valid()) return {exact};
  std::vector<ObjectId> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (lastPathPart(scene.objects[i].name) == name) found.push_back(ObjectId(i));
  }
  return found;
}

std::vector<PrimitiveId> primitivesOf(const Scene& scene, ObjectId root) {
  DELTALUX_CHECK(root.index() < scene.objects.size(), "no such object");
  std::vector<char> below(scene.objects.size(), 0);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    ObjectId object(i);
    while (object.valid() && object != root) object = scene[object].parent;
    below[i] = object == root;
  }
  std::vector<PrimitiveId> found;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const ObjectId object = scene.primitives[i].object;
    if (object.valid() && below[object.index()]) found.push_back(PrimitiveId(i));
  }
  return found;
}

std::vector<LightId> findLights(const Scene& scene, std::string_view name) {
  std::vector<LightId> found;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string_view candidate = scene.lights[i].name;
    const bool same = candidate == name;
    const bool below = candidate.size() > name.size() && candidate.starts_with(name) && candidate[name.size()] == '.';
    if (same || below) found.push_back(LightId(i));
  }
  return found;
}

void addAreaLights(Scene& scene) {
  std::vector<char> listed(scene.primitives.size(), 0);
  for (const Light& light : scene.lights) {
    if (const auto* area = std::get_if<AreaLight>(&light.emitter)) listed.at(area->primitive.index()) = 1;
  }
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const Primitive& primitive = scene.primitives[i];
    if (listed[i] || !sendsLight(scene[primitive.material]) || !(area(primitive.shape) > 0)) continue;
    const std::string name = primitive.object.valid() ? scene[primitive.object].name : "";
    scene.lights.push_back({name, AreaLight{PrimitiveId(i)}, Rgb(1.0f)});
  }
}

}  // namespace deltalux
