#include "io/radiance/scene_builder.hpp"

#include <deltalux/material.hpp>

#include "io/radiance/modifier_table.hpp"
#include "io/radiance/rad_shapes.hpp"
#include "io/radiance/rad_sources.hpp"
#include "scene/object_index.hpp"

namespace deltalux::io::radiance {

namespace {

class SceneBuilder {
 public:
  explicit SceneBuilder(const ImportSettings& settings)
      : modifiers_(result_.scene, result_.report), names_(result_.scene) {
    result_.scene.metresPerUnit = settings.metresPerUnit;
  }

  void add(const RadObject& object) {
    if (!isSurface(object.type)) {
      modifiers_.define(object);
    } else if (object.type == Type::Instance || object.type == Type::Mesh) {
      ignore(object.typeName);
    } else {
      addSurface(object);
    }
  }

  ImportedScene take() {
    addAreaLights(result_.scene);
    warn();
    return std::move(result_);
  }

 private:
  void ignore(const std::string& kind) { ++result_.report.ignored[kind]; }

  void addSurface(const RadObject& object) {
    const Modifier modifier = modifiers_.modifierOf(object);
    if (!modifier.unsupported.empty()) {
      throw inputError(object.where,
                       object.typeName + " '" + object.name + "' is made of '" + object.modifier + "', a " +
                           modifier.unsupported + ", which is not supported",
                       "give it plastic, metal, trans, glass, dielectric or mirror");
    }
    if (object.type == Type::Source) {
      addSource(object, modifier);
    } else if (!modifier.material.valid()) {
      ignore("surface without material");
    } else {
      addShapes(object, modifier.material);
    }
  }

  void addSource(const RadObject& object, const Modifier& modifier) {
    if (auto light = makeSource(object, modifier, result_.scene)) {
      const auto* dome = std::get_if<DomeLight>(&light->emitter);
      if (dome != nullptr && !sendsLight(result_.scene[modifier.material]))
        result_.scene.backdrops.push_back(*dome);
      else
        result_.scene.lights.push_back(std::move(*light));
      ++result_.report.surfaces["source"];
    } else {
      ignore("source without light");
    }
  }

  void addShapes(const RadObject& object, MaterialId material) {
    std::vector<Shape> shapes = makeShapes(object);
    if (shapes.empty()) return ignore("zero-area " + object.typeName);
    if (shapes.size() > 1 && bent_++ == 0) firstBent_ = object.where;
    const ObjectId owner = names_.intern(object.name, '.');
    for (Shape& shape : shapes) result_.scene.primitives.push_back({std::move(shape), material, owner});
    ++result_.report.surfaces[object.typeName];
  }

  void warn() {
    std::string skipped;
    for (const auto& [kind, count] : result_.report.ignored) {
      skipped += (skipped.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
    }
    if (!skipped.empty()) result_.report.warnings.push_back("ignored on import: " + skipped);
    if (bent_ > 0) {
      result_.report.warnings.push_back(std::to_string(bent_) +
                                        " polygons that are not planar were cut into triangles, " + "the first at " +
                                        *firstBent_.file + ":" + std::to_string(firstBent_.line));
    }
  }

  ImportedScene result_;
  ModifierTable modifiers_;
  scene::ObjectIndex names_;
  std::size_t bent_ = 0;
  SourceLine firstBent_;
};

}  // namespace

ImportedScene buildScene(const std::vector<RadObject>& objects, const ImportSettings& settings) {
  SceneBuilder builder(settings);
  for (const RadObject& object : objects) builder.add(object);
  return builder.take();
}

}  // namespace deltalux::io::radiance
