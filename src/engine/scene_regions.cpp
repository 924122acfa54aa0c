#include "engine/scene_regions.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "base/room.hpp"

namespace deltalux::engine {

SceneRegions::SceneRegions(const hierarchy::Elements& elements) {
  std::vector<Vec3f> centers;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.topology[i].kind == hierarchy::ElementKind::Patch && elements.topology[i].childCount == 0)
      centers.push_back(elements.geometry[i].center);
  split(1, centers);
  follow(elements);
}

void SceneRegions::split(std::size_t node, std::span<Vec3f> centers) {
  if (node >= kCount) return;
  Split& s = splits_[node];
  const std::size_t half = centers.size() / 2;
  if (!centers.empty()) {
    Vec3f lower = centers[0], upper = centers[0];
    for (const Vec3f& c : centers) lower = glm::min(lower, c), upper = glm::max(upper, c);
    const Vec3f size = upper - lower;
    s.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::nth_element(centers.begin(), centers.begin() + static_cast<std::ptrdiff_t>(half), centers.end(),
                     [&](const Vec3f& a, const Vec3f& b) { return a[s.axis] < b[s.axis]; });
    s.at = centers[half][s.axis];
  }
  split(2 * node, centers.first(half));
  split(2 * node + 1, centers.subspan(half));
}

void SceneRegions::follow(const hierarchy::Elements& elements) {
  const std::size_t known = of_.size();
  resizeWithRoom(of_, elements.size());
  parallelFor(elements.size() - known, 4096, [&](std::size_t k) {
    const std::size_t i = known + k;
    std::size_t node = 1;
    while (node < kCount) {
      const Split& s = splits_[node];
      node = 2 * node + (elements.geometry[i].center[s.axis] < s.at ? 0 : 1);
    }
    of_[i] = static_cast<std::uint8_t>(node - kCount);
  });
}

}  // namespace deltalux::engine
