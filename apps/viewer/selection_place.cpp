#include "selection_place.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "lamps.hpp"

namespace deltalux::viewer {

namespace {
/// The turn in an accumulated map, scaled axes made unit; none where it mirrors or shears.
glm::dmat3 ownAxes(const Scene& scene, PrimitiveId id) {
  const auto at = std::lower_bound(scene.placements.begin(), scene.placements.end(), id,
                                   [](const Placement& p, PrimitiveId i) { return p.primitive < i; });
  if (at == scene.placements.end() || at->primitive != id) return glm::dmat3(1.0);
  glm::dmat3 axes(at->matrix);
  constexpr double kRight = 1e-6;  // cosine between axes that stand upright on each other
  for (int i = 0; i < 3; ++i) {
    if (glm::length(axes[i]) == 0) return glm::dmat3(1.0);
    axes[i] = glm::normalize(axes[i]);
  }
  const bool upright = glm::length(glm::cross(axes[0], axes[1]) - axes[2]) < kRight;
  return upright ? axes : glm::dmat3(1.0);
}
}  // namespace

std::optional<SelectionPlace> placeOf(const Scene& scene, const std::string& name) {
  if (name.empty()) return std::nullopt;
  SelectionPlace place;
  for (const ObjectId object : findObjects(scene, name)) {
    const std::vector<PrimitiveId> below = primitivesOf(scene, object);
    place.primitives.insert(place.primitives.end(), below.begin(), below.end());
  }
  std::sort(place.primitives.begin(), place.primitives.end());
  place.primitives.erase(std::unique(place.primitives.begin(), place.primitives.end()), place.primitives.end());
  for (const PrimitiveId id : place.primitives) {
    const Box box = bounds(scene[id].shape);
    if (!box.empty()) place.box.extend(box);
  }
  place.lights = findLights(scene, name);
  for (const LightId id : place.lights)
    if (const auto at = placeOf(scene, id)) place.box.extend(*at);
  if (place.box.empty()) return std::nullopt;
  if (!place.primitives.empty()) place.axes = ownAxes(scene, place.primitives.front());
  return place;
}

}  // namespace deltalux::viewer
