#include "engine/scene_update.hpp"

namespace deltalux {

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
bool alike(const SunLight& a, const SunLight& b) {
  return a.direction == b.direction && a.angularRadius == b.angularRadius;
}
bool alike(const DomeLight& a, const DomeLight& b) {
  return a.axis == b.axis && a.halfAngle == b.halfAngle && a.up == b.up;
}
template <class A, class B>
bool alike(const A&, const B&) {
  return false;
}

}  // namespace

Restore applyInto(SceneUpdate& update, Scene& scene, const Edit& edit) {
  const std::vector<Light> before = scene.lights;
  const std::size_t primitives = scene.primitives.size();
  const AppliedEdit applied = applyEdit(scene, edit);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(update.whole.moved, applied.change.moved);
  append(update.whole.lights, applied.change.lights);
  append(update.whole.materials, applied.change.materials);
  update.grown |= scene.primitives.size() > primitives;
  for (const SceneChange::Moved& m : applied.change.moved) {
    update.moved.push_back(m);
    // What was not there may have no element to come back to.
    update.grown |= m.before.empty() && !m.after.empty();
  }
  for (const LightId light : applied.change.lights) {
    const bool stays =
        light.index() < before.size() && std::visit([](const auto& a, const auto& b) { return alike(a, b); },
                                                    before[light.index()].emitter, scene[light].emitter);
    (stays ? update.dimmed : update.movedLights).push_back(light);
  }
  update.materials.insert(update.materials.end(), applied.change.materials.begin(), applied.change.materials.end());
  update.op = editOperation(edit);
  update.subject = editSubject(edit);
  return applied.inverse;
}

}  // namespace deltalux
