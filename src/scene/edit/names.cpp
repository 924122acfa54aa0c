#include <deltalux/error.hpp>

#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

void refuse(const std::string& message, const std::string& hint) { throw InputError("", 0, message, hint); }

namespace {

template <class Things>
[[noreturn]] void refuseUnknown(const char* kind, const std::string& name, const Things& things) {
  std::vector<std::string> existing;
  for (const auto& thing : things) existing.push_back(thing.name);
  std::string hint;
  for (const std::string& near : nearMisses(name, existing)) hint += (hint.empty() ? "nearest: " : ", ") + near;
  refuse(std::string("there is no ") + kind + " '" + name + "'", hint.empty() ? "the scene has none" : hint);
}

}  // namespace

std::vector<ObjectId> objectsNamed(const Scene& scene, const std::string& name) {
  std::vector<ObjectId> found = findObjects(scene, name);
  if (found.empty()) refuseUnknown("object", name, scene.objects);
  return found;
}

std::vector<LightId> lightsNamed(const Scene& scene, const std::string& name) {
  std::vector<LightId> found = findLights(scene, name);
  if (found.empty()) refuseUnknown("light", name, scene.lights);
  return found;
}

std::vector<MaterialId> materialsNamed(const Scene& scene, const std::string& name) {
  std::vector<MaterialId> found;
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].name == name) found.emplace_back(i);
  if (found.empty()) refuseUnknown("material", name, scene.materials);
  return found;
}

}  // namespace deltalux::scene::edits
