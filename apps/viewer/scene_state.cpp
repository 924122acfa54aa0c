#include "scene_state.hpp"

#include <algorithm>

namespace deltalux::viewer {

namespace {

Restore::PrimitiveState primitiveState(const Scene& scene, PrimitiveId id) {
  Restore::PrimitiveState state{id, scene[id].material, Mat4(1.0), true};
  const auto at = std::lower_bound(scene.placements.begin(), scene.placements.end(), id,
                                   [](const Placement& p, PrimitiveId wanted) { return p.primitive < wanted; });
  if (at != scene.placements.end() && at->primitive == id) state.matrix = at->matrix, state.present = at->present;
  return state;
}

Restore::LightState lightState(const Scene& scene, LightId id) {
  Restore::LightState state{id, scene[id], std::nullopt};
  for (const SwitchedOff& off : scene.switchedOff)
    if (off.light == id) state.offScale = off.scale;
  return state;
}

/// The same things in the same order, or none before.
template <class States, class Key>
bool sameThings(const States& later, const States& earlier, const Key& key) {
  return earlier.empty() || std::equal(later.begin(), later.end(), earlier.begin(), earlier.end(),
                                       [&](const auto& a, const auto& b) { return key(a) == key(b); });
}

}  // namespace

Restore presentState(const Scene& scene, const Restore& things) {
  Restore state;
  for (const auto& p : things.primitives) state.primitives.push_back(primitiveState(scene, p.primitive));
  for (const auto& l : things.lights) state.lights.push_back(lightState(scene, l.light));
  for (const auto& m : things.materials) state.materials.push_back({m.material, scene[m.material]});
  return state;
}

bool covers(const Restore& later, const Restore& earlier) {
  return sameThings(later.primitives, earlier.primitives, [](const auto& s) { return s.primitive; }) &&
         sameThings(later.lights, earlier.lights, [](const auto& s) { return s.light; }) &&
         sameThings(later.materials, earlier.materials, [](const auto& s) { return s.material; });
}

}  // namespace deltalux::viewer
