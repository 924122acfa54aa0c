#include "scene/object_index.hpp"

#include "scene/name_prefixes.hpp"

namespace deltalux::scene {

ObjectIndex::ObjectIndex(Scene& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) byName_.emplace(scene.objects[i].name, ObjectId(i));
}

ObjectId ObjectIndex::intern(std::string_view name, char separator) {
  if (const auto known = byName_.find(name); known != byName_.end()) return known->second;
  ObjectId parent;
  forEachPrefix(name, separator, [&](std::string_view prefix) { parent = findOrMake(prefix, parent); });
  return parent;
}

ObjectId ObjectIndex::findOrMake(std::string_view name, ObjectId parent) {
  if (const auto known = byName_.find(name); known != byName_.end()) return known->second;
  const ObjectId made(scene_.objects.size());
  scene_.objects.push_back({std::string(name), parent});
  byName_.emplace(std::string(name), made);
  return made;
}

}  // namespace deltalux::scene
