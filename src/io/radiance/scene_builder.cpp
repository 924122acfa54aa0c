#include "io/radiance/scene_builder.hpp"

#include <deltalux/material.hpp>

#include "io/radiance/emission_patterns.hpp"
#include "io/radiance/modifier_table.hpp"
#include "io/radiance/rad_shapes.hpp"
#include "io/radiance/rad_sources.hpp"
#include "io/radiance/surface_patterns.hpp"
#include "scene/object_index.hpp"

namespace deltalux::io::radiance {

namespace {

class SceneBuilder {
 public:
  SceneBuilder(FileAccess& files, const ImportSettings& settings, const ExpansionLimits& limits)
      : modifiers_(result_.scene, result_.report),
        patterns_(result_.scene, result_.report, files, limits.patternCalls),
        surfaces_(result_.scene, result_.report, files, limits.patternCalls),
        names_(result_.scene) {
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
    modifiers_.noteUnread([&](const RadObject& pattern) { return patterns_.asked(pattern); },
                          [&](const RadObject& pattern) { return surfaces_.asked(pattern); });
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
      addShapes(object, modifier);
    }
  }

  void addSource(const RadObject& object, const Modifier& modifier) {
    if (auto light = makeSource(object, modifier, result_.scene)) {
      patterns_.apply(modifier, *light);
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

  void addShapes(const RadObject& object, const Modifier& modifier) {
    std::vector<Shape> shapes = makeShapes(object);
    if (shapes.empty()) return ignore("zero-area " + object.typeName);
    if (shapes.size() > 1 && bent_++ == 0) firstBent_ = object.where;
    const ObjectId owner = names_.intern(object.name, '.');
    for (Shape& shape : shapes) {
      if (result_.scene[modifier.material].emission) {
        const MaterialId material = patterns_.materialFor(modifier, shape);
        result_.scene.primitives.push_back({std::move(shape), material, owner});
      } else {
        auto [surface, material] = surfaces_.apply(modifier, std::move(shape));
        result_.scene.primitives.push_back({std::move(surface), material, owner});
      }
    }
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
  EmissionPatterns patterns_;
  SurfacePatterns surfaces_;
  scene::ObjectIndex names_;
  std::size_t bent_ = 0;
  SourceLine firstBent_;
};

}  // namespace

ImportedScene buildScene(const std::vector<RadObject>& objects, FileAccess& files, const ImportSettings& settings,
                         const ExpansionLimits& limits) {
  SceneBuilder builder(files, settings, limits);
  for (const RadObject& object : objects) builder.add(object);
  return builder.take();
}

}  // namespace deltalux::io::radiance
