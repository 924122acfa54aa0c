#include "engine/moving_groups.hpp"

#include <algorithm>

#include "base/few_boxes.hpp"
#include "base/sort_unique.hpp"
#include "base/tuning.hpp"

namespace deltalux::engine {

void MovingGroups::separate(tracing::RayTracer& tracer, const Scene& scene, std::span<const PrimitiveId> primitives) {
  if (primitives.empty()) return;
  const tracing::GroupId group = groupOf(primitives[0]);
  const auto together = [&](PrimitiveId p) { return groupOf(p) == group; };
  const auto size = static_cast<std::size_t>(std::count(groups_.begin(), groups_.end(), group));
  if (group != tracing::GroupId(0) && size == primitives.size() &&
      std::all_of(primitives.begin(), primitives.end(), together))
    return;
  setApart(tracer, scene, primitives);
}

void MovingGroups::setApart(tracing::RayTracer& tracer, const Scene& scene, std::span<const PrimitiveId> primitives) {
  if (separated_ == kFewBoxes) {
    tracer.rejoin();
    groups_.clear(), separated_ = 0;
  }
  groups_.resize(scene.primitives.size(), tracing::GroupId(0));
  const tracing::GroupId own = tracer.separate(primitives);
  for (const PrimitiveId p : primitives) groups_[p.index()] = own;
  ++separated_;
}

void MovingGroups::rebuild(tracing::RayTracer& tracer, const Scene& scene, std::span<const PrimitiveId> moved) {
  std::vector<PrimitiveId> loose;
  std::vector<tracing::GroupId> groups;
  for (const PrimitiveId p : moved)
    if (groupOf(p) == tracing::GroupId(0))
      loose.push_back(p);
    else
      groups.push_back(groupOf(p));
  sortUnique(groups);
  for (const tracing::GroupId g : groups) tracer.rebuild(g);
  if (!loose.empty()) setApart(tracer, scene, loose);
}

}  // namespace deltalux::engine
