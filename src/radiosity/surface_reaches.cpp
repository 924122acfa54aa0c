#include "radiosity/surface_reaches.hpp"

#include "base/parallel.hpp"
#include "base/room.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kBeside = 0.1f;  // of a leaf's radius: as near is upon it
constexpr int kFinestReach = 3;  // subdivisions of the input level

hierarchy::ElementId partOf(const hierarchy::Elements& elements, hierarchy::ElementId leaf) {
  while (elements.at(leaf).depth > kFinestReach) leaf = elements.at(leaf).parent;
  return leaf;
}

}  // namespace

Box SurfaceReaches::beside(const hierarchy::ElementGeometry& leaf) {
  return {Vec3(leaf.lower - kBeside * leaf.radius), Vec3(leaf.upper + kBeside * leaf.radius)};
}

void SurfaceReaches::add(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const TransferRow& direct,
                         const TransferRow& indirect) {
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  const hierarchy::ElementId part = partOf(elements, leaf);
  if (part.index() >= slot_.size()) resizeWithRoom(slot_, elements.size(), kNone);
  std::uint32_t& slot = slot_[part.index()];
  if (slot == kNone) {
    slot = static_cast<std::uint32_t>(surfaces_.size());
    surfaces_.push_back({part, g.lower, g.upper, {}});
  }
  Surface& s = surfaces_[slot];
  const Box upon = beside(g);
  s.lower = glm::min(s.lower, Vec3f(upon.lower)), s.upper = glm::max(s.upper, Vec3f(upon.upper));
  for (const RowReach* reach : {&direct.reach, &indirect.reach}) {
    reach->extend(g, s.lower, s.upper);
    s.objects.add(reach->objects);
  }
}

std::vector<hierarchy::ElementId> SurfaceReaches::met(const paper::SpaceChange& space, bool everywhere) const {
  const auto isMet = [&](std::size_t i) {
    const Surface& s = surfaces_[i];
    return everywhere || space.meets(s.objects) || (space.meets(s.lower, s.upper) && !space.hiddenFrom(s.element));
  };
  std::vector<hierarchy::ElementId> found;
  for (const std::size_t i : parallelWhere(surfaces_.size(), 1024, isMet)) found.push_back(surfaces_[i].element);
  return found;
}

bool SurfaceReaches::holds(const hierarchy::Elements& elements, hierarchy::ElementId leaf,
                           const TransferRow& row) const {
  const hierarchy::ElementId part = partOf(elements, leaf);
  if (part.index() >= slot_.size() || slot_[part.index()] == kNone) return false;
  const Surface& s = surfaces_[slot_[part.index()]];
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  Vec3f lower = g.lower, upper = g.upper;
  row.reach.extend(g, lower, upper);
  return s.objects.holds(row.reach.objects) && glm::all(glm::lessThanEqual(s.lower, lower)) &&
         glm::all(glm::lessThanEqual(upper, s.upper));
}

std::size_t SurfaceReaches::memoryBytes() const {
  return surfaces_.capacity() * sizeof surfaces_[0] + slot_.capacity() * sizeof slot_[0];
}

}  // namespace deltalux::radiosity
