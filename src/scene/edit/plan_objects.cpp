#include <algorithm>

#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

namespace {

bool belongsTo(const std::string& name, const std::string& object) {
  return name.starts_with(object) &&
         (name.size() == object.size() || name[object.size()] == '.' || name[object.size()] == '/');
}

/// Where removed surfaces had their lights: nothing is sent from here.
Light darkened(const Light& light) { return {light.name, PointLight{}, light.scale}; }

struct Parts {
  std::vector<PrimitiveId> primitives;  // present ones, ascending
  std::vector<LightId> lights;          // area lights on them
  std::vector<LightId> points;          // other lights that belong to the objects by name
};

Parts partsOf(const Scene& scene, const std::string& name) {
  Parts parts;
  std::vector<char> mine(scene.primitives.size(), 0);
  const std::vector<ObjectId> objects = objectsNamed(scene, name);
  for (const ObjectId object : objects)
    for (const PrimitiveId p : primitivesOf(scene, object)) mine[p.index()] = stateOf(scene, p).present;
  for (std::size_t i = 0; i < mine.size(); ++i)
    if (mine[i]) parts.primitives.emplace_back(i);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (const auto* area = std::get_if<AreaLight>(&light.emitter)) {
      if (mine[area->primitive.index()]) parts.lights.emplace_back(i);
      continue;
    }
    const bool placed = std::visit(
        [](const auto& e) {
          return requires { e.position; };
        },
        light.emitter);
    if (placed && !isDark(light) &&
        std::any_of(objects.begin(), objects.end(), [&](ObjectId o) { return belongsTo(light.name, scene[o].name); }))
      parts.points.emplace_back(i);
  }
  if (parts.primitives.empty() && parts.points.empty()) refuse("'" + name + "' has no surface and no light any more");
  return parts;
}

bool hasDirection(const Material& m) { return m.emission && isDirectional(*m.emission); }

}  // namespace

void planMove(Plan& plan, const Scene& scene, PrimitiveId primitive, const Mat4& matrix) {
  Restore::PrimitiveState state = stateOf(scene, primitive);
  state.matrix = withoutRounding(matrix * state.matrix, scene);
  const Material& material = scene.materialOf(primitive);
  if (hasDirection(material)) {
    // The direction is the material's, which others may share: the surface gets one of its own.
    Material own = material;
    turn(*own.emission, glm::dmat3(matrix));
    if (!(*own.emission == *material.emission)) {
      state.material = MaterialId(scene.materials.size() + plan.materials.size());
      plan.materials.push_back(std::move(own));
    }
  }
  plan.target.primitives.push_back(state);
}

Light movedLight(const Light& light, const Mat4& matrix) {
  Light result = light;
  const auto turn = [&](const Vec3& v) { return glm::normalize(glm::dmat3(matrix) * v); };
  std::visit(
      [&](auto& emitter) {
        if constexpr (requires { emitter.position; }) emitter.position = Vec3(matrix * glm::dvec4(emitter.position, 1));
        if constexpr (requires {
                        emitter.position;
                        emitter.direction;
                      })
          emitter.direction = turn(emitter.direction);
        if constexpr (requires { emitter.frame; })
          for (int c = 0; c < 3; ++c) emitter.frame[c] = turn(emitter.frame[c]);
      },
      result.emitter);
  return result;
}

Plan plan(const Scene& scene, const TransformObject& edit) {
  const Parts parts = partsOf(scene, edit.object);
  const Mat4 matrix = between(edit.matrix, scene.origin, scene.origin);
  Plan result;
  for (const PrimitiveId p : parts.primitives) planMove(result, scene, p, matrix);
  for (const LightId l : parts.points) {
    Restore::LightState state = stateOf(scene, l);
    state.value = movedLight(state.value, matrix);
    result.target.lights.push_back(std::move(state));
  }
  return result;
}

Plan plan(const Scene& scene, const RemoveObject& edit) {
  const Parts parts = partsOf(scene, edit.object);
  Plan result;
  for (const PrimitiveId p : parts.primitives) {
    result.target.primitives.push_back(stateOf(scene, p));
    result.target.primitives.back().present = false;
  }
  for (const auto* lights : {&parts.lights, &parts.points})
    for (const LightId l : *lights) {
      Restore::LightState state = stateOf(scene, l);
      state.value = darkened(state.value);
      result.target.lights.push_back(std::move(state));
    }
  return result;
}

namespace {

/// Watts of `part` that are one of the scene's in lumens.
float wattsOf(const Scene& scene, const Scene& part) {
  return static_cast<float>(part.luminousEfficacy / scene.luminousEfficacy);
}

/// Materials and textures of `part` behind those of the scene.
void appendMaterials(Plan& plan, const Scene& scene, const Scene& part) {
  plan.textures = part.textures;
  plan.materials = part.materials;
  for (Material& m : plan.materials)
    if (m.emission) m.emission->radiance *= wattsOf(scene, part);
  for (Material& m : plan.materials)
    if (auto* opaque = std::get_if<Opaque>(&m.surface); opaque && opaque->diffuseTexture.valid())
      opaque->diffuseTexture = TextureId(scene.textures.size() + opaque->diffuseTexture.index());
}

/// A light of `part` where the matrix puts it in the scene, as bright in lumens.
Light addedLight(const Light& light, const Mat4& matrix, float watts) {
  Light own = movedLight(light, matrix);
  std::visit(
      [&](auto& emitter) {
        if constexpr (requires { emitter.intensity; }) emitter.intensity *= watts;
        if constexpr (requires { emitter.photometry; }) emitter.scale *= watts;
      },
      own.emitter);
  return own;
}

}  // namespace

Plan plan(const Scene& scene, const AddObject& edit) {
  if (!edit.part) refuse("nothing is given to add as '" + edit.object + "'");
  if (edit.object.empty()) refuse("what is added needs a name");
  for (const ObjectId o : findObjects(scene, edit.object))
    for (const PrimitiveId p : primitivesOf(scene, o))
      if (stateOf(scene, p).present) refuse("there is an object '" + edit.object + "' already", "choose another name");
  const Scene& part = *edit.part;
  if (part.primitives.empty()) refuse("there is no surface in " + (edit.file.empty() ? "what is added" : edit.file));
  const Mat4 matrix = between(edit.matrix, part.origin, scene.origin);
  Plan result;
  appendMaterials(result, scene, part);
  const std::size_t first = scene.primitives.size(), firstMaterial = scene.materials.size();
  for (std::size_t i = 0; i < part.primitives.size(); ++i) {
    const Primitive& p = part.primitives[i];
    Restore::PrimitiveState state{PrimitiveId(first + i), MaterialId(firstMaterial + p.material.index()),
                                  withoutRounding(matrix, scene), true};
    if (hasDirection(part[p.material])) {
      result.materials.push_back(Material(result.materials[p.material.index()]));
      turn(*result.materials.back().emission, glm::dmat3(matrix));
      state.material = MaterialId(firstMaterial + result.materials.size() - 1);
    }
    result.primitives.push_back({p.shape, state.material, ObjectId()});
    result.objectNames.push_back(p.object.valid() ? edit.object + "." + part[p.object].name : edit.object);
    result.target.primitives.push_back(state);
  }
  for (const Light& light : part.lights) {
    Light own = addedLight(light, matrix, wattsOf(scene, part));
    if (auto* area = std::get_if<AreaLight>(&own.emitter))
      area->primitive = PrimitiveId(first + area->primitive.index());
    else if (!std::visit(
                 [](const auto& e) {
                   return requires { e.position; };
                 },
                 own.emitter))
      continue;  // sun and sky are the scene's own
    own.name = edit.object + "." + own.name;
    result.target.lights.push_back({LightId(scene.lights.size() + result.lights.size()), own, std::nullopt});
    result.lights.push_back(darkened(own));
  }
  return result;
}

}  // namespace deltalux::scene::edits
