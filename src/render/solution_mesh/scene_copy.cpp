#include "render/solution_mesh/scene_copy.hpp"

#include <algorithm>

namespace deltalux::rendering {

namespace {

bool alikeMaterials(const Material& a, const Material& b) {
  return a.name == b.name && a.surface == b.surface && a.emission == b.emission && a.coverage == b.coverage &&
         a.filter == b.filter;
}

bool alikeLights(const Light& a, const Light& b) {
  return a.name == b.name && a.emitter == b.emitter && a.scale == b.scale;
}

template <class T, class Alike>
bool allAlike(const std::vector<T>& a, const std::vector<T>& b, const Alike& alike) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
}

}  // namespace

bool hasSameShapes(const Scene& copy, const Scene& now) {
  // Shapes change by way of their placements alone.
  return copy.primitives.size() == now.primitives.size() && copy.origin == now.origin &&
         allAlike(copy.placements, now.placements, [](const Placement& a, const Placement& b) {
           return a.primitive == b.primitive && a.matrix == b.matrix && a.present == b.present;
         });
}

bool isUpToDate(const Scene& copy, const Scene& now) {
  return hasSameShapes(copy, now) && copy.objects.size() == now.objects.size() &&
         copy.textures.size() == now.textures.size() && copy.views.size() == now.views.size() &&
         copy.backdrops.size() == now.backdrops.size() && allAlike(copy.materials, now.materials, alikeMaterials) &&
         allAlike(copy.lights, now.lights, alikeLights) &&
         allAlike(
             copy.primitives, now.primitives,
             [](const Primitive& a, const Primitive& b) { return a.material == b.material && a.object == b.object; }) &&
         allAlike(copy.switchedOff, now.switchedOff,
                  [](const SwitchedOff& a, const SwitchedOff& b) { return a.light == b.light && a.scale == b.scale; });
}

}  // namespace deltalux::rendering
