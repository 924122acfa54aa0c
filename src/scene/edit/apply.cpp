#include <algorithm>

#include "base/check.hpp"
#include "base/sort_unique.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::scene {

namespace edits {

Plan plan(const Scene& scene, const Restore& edit) {
  for (const auto& p : edit.primitives)
    DELTALUX_CHECK(p.primitive.index() < scene.primitives.size() && p.material.index() < scene.materials.size(),
                   "a restored primitive is of another scene");
  for (const auto& l : edit.lights) DELTALUX_CHECK(l.light.index() < scene.lights.size(), "a light of another scene");
  for (const auto& m : edit.materials)
    DELTALUX_CHECK(m.material.index() < scene.materials.size(), "a material of another scene");
  Plan result;
  result.target = edit;
  return result;
}

namespace {

/// Shapes to come, one per state of the plan: all that can be wrong is found before anything changes.
std::vector<Shape> shapesOf(const Scene& scene, const Plan& plan) {
  std::vector<Shape> shapes;
  for (const Restore::PrimitiveState& state : plan.target.primitives) {
    const std::size_t i = state.primitive.index(), known = scene.primitives.size();
    shapes.push_back(
        shapeOf(scene, state, i < known ? restShape(scene, state.primitive) : plan.primitives[i - known].shape));
  }
  return shapes;
}

void placeRest(Scene& scene, const Restore::PrimitiveState& state, Shape rest) {
  const auto at = std::lower_bound(scene.placements.begin(), scene.placements.end(), state.primitive,
                                   [](const Placement& p, PrimitiveId id) { return p.primitive < id; });
  if (at != scene.placements.end() && at->primitive == state.primitive)
    at->matrix = state.matrix, at->present = state.present;
  else
    scene.placements.insert(at, {state.primitive, std::move(rest), state.matrix, state.present});
}

/// New things, not there yet: as their inverse will leave them.
void append(Scene& scene, Plan& plan) {
  scene.textures.insert(scene.textures.end(), plan.textures.begin(), plan.textures.end());
  scene.materials.insert(scene.materials.end(), plan.materials.begin(), plan.materials.end());
  scene.lights.insert(scene.lights.end(), plan.lights.begin(), plan.lights.end());
  for (std::size_t i = 0; i < plan.primitives.size(); ++i) {
    Primitive& p = plan.primitives[i];
    const PrimitiveId id(scene.primitives.size());
    const ObjectId object = internObject(scene, plan.objectNames[i], '.');
    placeRest(scene, {id, p.material, Mat4(1.0), false}, std::move(p.shape));
    scene.primitives.push_back({removedShape(), p.material, object});
  }
}

bool sameShape(const Restore::PrimitiveState& a, const Restore::PrimitiveState& b) {
  return a.matrix == b.matrix && a.present == b.present;
}

void restorePrimitive(Scene& scene, const Restore::PrimitiveState& state, Shape shape, AppliedEdit& applied) {
  const Restore::PrimitiveState before = stateOf(scene, state.primitive);
  applied.inverse.primitives.push_back(before);
  Primitive& primitive = scene.primitives[state.primitive.index()];
  if (!sameShape(before, state)) {
    SceneChange::Moved moved{state.primitive, bounds(primitive.shape), bounds(shape)};
    placeRest(scene, state, primitive.shape);
    primitive.shape = std::move(shape);
    applied.change.moved.push_back(moved);
  }
  if (primitive.material != state.material) applied.change.materials.push_back(state.material);
  primitive.material = state.material;
}

void restoreLight(Scene& scene, const Restore::LightState& state, AppliedEdit& applied) {
  applied.inverse.lights.push_back(stateOf(scene, state.light));
  scene.lights[state.light.index()] = state.value;
  std::erase_if(scene.switchedOff, [&](const SwitchedOff& s) { return s.light == state.light; });
  if (state.offScale) scene.switchedOff.push_back({state.light, *state.offScale});
  applied.change.lights.push_back(state.light);
}

/// Area lights on surfaces that moved or changed their material send otherwise too.
void noteAreaLights(const Scene& scene, AppliedEdit& applied) {
  std::vector<char> touched(scene.primitives.size(), 0);
  for (const auto& p : applied.inverse.primitives) touched[p.primitive.index()] = 1;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const auto* area = std::get_if<AreaLight>(&scene.lights[i].emitter); area && touched[area->primitive.index()])
      applied.change.lights.emplace_back(i);
  std::vector<LightId>& lights = applied.change.lights;
  sortUnique(lights);
}

AppliedEdit carryOut(Scene& scene, Plan plan) {
  std::vector<Shape> shapes = shapesOf(scene, plan);
  append(scene, plan);
  AppliedEdit applied;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    restorePrimitive(scene, plan.target.primitives[i], std::move(shapes[i]), applied);
  for (const auto& state : plan.target.lights) restoreLight(scene, state, applied);
  for (const auto& state : plan.target.materials) {
    Material& material = scene.materials[state.material.index()];
    applied.inverse.materials.push_back({state.material, material});
    applied.change.materials.push_back(state.material);
    material = state.value;
  }
  noteAreaLights(scene, applied);
  return applied;
}

Plan planOf(const Scene& scene, const Edit& edit) {
  return std::visit([&](const auto& e) { return plan(scene, e); }, edit);
}

}  // namespace

}  // namespace edits

}  // namespace deltalux::scene

namespace deltalux {

AppliedEdit applyEdit(Scene& scene, const Edit& edit) {
  return scene::edits::carryOut(scene, scene::edits::planOf(scene, edit));
}

void validateEdit(const Scene& scene, const Edit& edit) {
  scene::edits::shapesOf(scene, scene::edits::planOf(scene, edit));
}

std::string editOperation(const Edit& edit) {
  constexpr const char* names[] = {"transform", "add",   "remove",   "light", "light",  "light",
                                   "light",     "light", "material", "sky",   "restore"};
  static_assert(std::size(names) == std::variant_size_v<Edit>);
  return names[edit.index()];
}

std::string editSubject(const Edit& edit) {
  return std::visit(
      [](const auto& e) -> std::string {
        if constexpr (requires { e.object; })
          return e.object;
        else if constexpr (requires { e.light; })
          return e.light;
        else if constexpr (requires { e.material; })
          return e.material;
        else
          return {};
      },
      edit);
}

AppliedEdit EditHistory::apply(Scene& scene, const Edit& edit) {
  AppliedEdit applied = applyEdit(scene, edit);
  undo_.push_back(applied.inverse);
  redo_.clear();
  return applied;
}

AppliedEdit EditHistory::undo(Scene& scene) {
  DELTALUX_CHECK(canUndo(), "there is nothing to undo");
  AppliedEdit applied = applyEdit(scene, undo_.back());
  undo_.pop_back();
  redo_.push_back(applied.inverse);
  return applied;
}

AppliedEdit EditHistory::redo(Scene& scene) {
  DELTALUX_CHECK(canRedo(), "there is nothing to redo");
  AppliedEdit applied = applyEdit(scene, redo_.back());
  redo_.pop_back();
  undo_.push_back(applied.inverse);
  return applied;
}

}  // namespace deltalux
