#include "render/standing.hpp"

#include <algorithm>
#include <map>

#include "base/parallel.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kPrimitivesBlock = 512;  // [task]

BoxF floatBox(const Box& box) { return box.empty() ? BoxF{} : BoxF{Vec3f(box.lower), Vec3f(box.upper)}; }

bool sameBox(const BoxF& a, const BoxF& b) { return a.lower == b.lower && a.upper == b.upper; }

}  // namespace

Standing::Standing(const Scene& scene) : boxes_(scene.primitives.size()), materials_(scene.primitives.size()) {
  parallelFor(boxes_.size(), kPrimitivesBlock, [&](std::size_t i) {
    boxes_[i] = floatBox(bounds(scene.primitives[i].shape));
    materials_[i] = scene.primitives[i].material;
  });
  for (const Placement& p : scene.placements) {
    placed_.push_back({p.primitive, p.matrix});
    if (!p.present) boxes_[p.primitive.index()] = BoxF{};
  }
}

std::vector<char> Standing::changedSince(const Standing& before) const {
  std::vector<char> moved(std::max(boxes_.size(), before.boxes_.size()), 0);
  for (std::size_t i = 0; i < moved.size(); ++i)
    moved[i] = i >= boxes_.size() || i >= before.boxes_.size() || !sameBox(boxes_[i], before.boxes_[i]) ||
               materials_[i] != before.materials_[i];
  // What was turned may have the same box.
  std::map<PrimitiveId, Mat4> was(before.placed_.begin(), before.placed_.end());
  for (const auto& [primitive, matrix] : placed_) {
    const auto found = was.find(primitive);
    if (found == was.end() || found->second != matrix) moved[primitive.index()] = 1;
    if (found != was.end()) was.erase(found);
  }
  for (const auto& [primitive, matrix] : was) moved[primitive.index()] = 1;
  return moved;
}

std::vector<BoxF> Standing::movedSince(const Standing& before) const {
  const std::vector<char> moved = changedSince(before);
  std::vector<BoxF> result;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!moved[i]) continue;
    for (const auto* boxes : {&before.boxes_, &boxes_})
      if (i < boxes->size() && (*boxes)[i].lower.x <= (*boxes)[i].upper.x) result.push_back((*boxes)[i]);
  }
  return result;
}

}  // namespace deltalux::rendering
