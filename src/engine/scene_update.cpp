#include "engine/scene_update.hpp"

#include <algorithm>

#include "scene/edit/plan.hpp"

#include "hierarchy/input_level.hpp"

namespace deltalux::engine {

namespace {

bool alike(const AreaLight& a, const AreaLight& b) { return a.primitive == b.primitive; }
bool alike(const PointLight& a, const PointLight& b) { return a.position == b.position; }
bool alike(const SpotLight& a, const SpotLight& b) {
  return a.position == b.position && a.direction == b.direction && a.cosInner == b.cosInner && a.cosOuter == b.cosOuter;
}
bool alike(const LambertPointLight& a, const LambertPointLight& b) {
  return a.position == b.position && a.direction == b.direction;
}
bool alike(const PhotometricLight& a, const PhotometricLight& b) {
  return a.position == b.position && a.frame == b.frame && a.photometry == b.photometry;
}
bool alike(const SunLight& a, const SunLight& b) { return a == b; }
bool alike(const DomeLight& a, const DomeLight& b) { return a == b; }
template <class A, class B>
bool alike(const A&, const B&) {
  return false;
}

}  // namespace

void SceneUpdate::add(const SceneUpdate& later) {
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(whole.moved, later.whole.moved), append(whole.lights, later.whole.lights);
  append(whole.materials, later.whole.materials);
  append(moved, later.moved), append(movedLights, later.movedLights), append(dimmed, later.dimmed);
  append(materials, later.materials);
  op = later.op, subject = later.subject;
}

std::vector<PrimitiveId> SceneUpdate::primitives() const {
  std::vector<PrimitiveId> all;
  for (const SceneChange::Moved& m : moved) all.push_back(m.primitive);
  return all;
}

std::vector<char> lightsThatMoved(const Scene& scene, const SceneUpdate& edits) {
  std::vector<char> moved(scene.lights.size(), 0);
  for (const LightId light : edits.movedLights) moved[light.index()] = 1;
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (const auto* area = std::get_if<AreaLight>(&scene.lights[i].emitter))
      for (const SceneChange::Moved& m : edits.moved) moved[i] |= m.primitive == area->primitive;
  return moved;
}

std::vector<hierarchy::ElementId> paintedSurfaces(const hierarchy::Elements& elements, const Scene& scene,
                                                  std::span<const MaterialId> materials) {
  std::vector<PrimitiveId> all;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    if (std::ranges::find(materials, scene.primitives[i].material) != materials.end()) all.emplace_back(i);
  std::vector<hierarchy::ElementId> surfaces = hierarchy::elementsOf(elements, all);
  std::erase_if(surfaces, [&](hierarchy::ElementId e) { return elements.at(e).emitter; });
  return surfaces;
}

SceneUpdate endToEnd(SceneUpdate edits) {
  for (std::vector<SceneChange::Moved>* all : {&edits.moved, &edits.whole.moved}) {
    std::vector<SceneChange::Moved> ends;
    std::vector<std::size_t> place;  // by primitive: one more than its index in `ends`
    for (const SceneChange::Moved& m : *all) {
      place.resize(std::max(place.size(), m.primitive.index() + 1), 0);
      std::size_t& at = place[m.primitive.index()];
      if (at == 0)
        ends.push_back(m), at = ends.size();
      else
        ends[at - 1].after = m.after;
    }
    all->swap(ends);
  }
  return edits;
}

bool haveElements(const hierarchy::Elements& elements, const Scene& scene, const SceneUpdate& update) {
  const bool nothing = update.moved.empty() && update.movedLights.empty();
  if (!elements.sceneRoot.valid()) return nothing;  // nothing was lit
  std::vector<char> has(scene.lights.size(), 0);    // by light: an element of its kind
  for (const hierarchy::ElementId e : elements.inputs) {
    const LightId light = elements.light[e.index()];
    if (!light.valid()) continue;
    // A surface that is no more is a dark point, whose element is a patch still; and the other way round.
    const bool surface = std::holds_alternative<AreaLight>(scene[light].emitter);
    if (surface == elements.isPatch(e)) has[light.index()] = 1;
  }
  return std::all_of(update.movedLights.begin(), update.movedLights.end(),
                     [&](LightId light) { return has[light.index()] || scene::edits::isDark(scene[light]); });
}

Restore applyInto(SceneUpdate& update, Scene& scene, const Edit& edit) {
  const std::vector<Light> before = scene.lights;
  const AppliedEdit applied = applyEdit(scene, edit);
  SceneUpdate made{applied.change,      applied.change.moved, {}, {}, applied.change.materials,
                   editOperation(edit), editSubject(edit)};
  for (const LightId light : applied.change.lights) {
    const bool stays =
        light.index() < before.size() && std::visit([](const auto& a, const auto& b) { return alike(a, b); },
                                                    before[light.index()].emitter, scene[light].emitter);
    (stays ? made.dimmed : made.movedLights).push_back(light);
  }
  update.add(made);
  return applied.inverse;
}

}  // namespace deltalux::engine
