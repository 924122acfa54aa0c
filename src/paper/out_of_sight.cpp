#include "paper/out_of_sight.hpp"

#include "paper/hidden_elements.hpp"

namespace deltalux::paper {

OutOfSight::OutOfSight(const hierarchy::Elements& elements, const Scene& scene, const Box& region)
    : elements_(elements),
      region_(region),
      size_(elements.size()),
      state_(std::make_unique<std::atomic<std::uint8_t>[]>(elements.size())) {
  for (const HiddenElement& h : hiddenElements(elements, scene, region))
    state_[h.element.index()].store(kHidden, std::memory_order_relaxed);
}

std::uint8_t OutOfSight::state(hierarchy::ElementId e) const {
  while (e.index() >= size_) e = elements_.at(e).parent;  // it was split since
  std::atomic<std::uint8_t>& known = state_[e.index()];
  std::uint8_t state = known.load(std::memory_order_relaxed);
  if (state != kUnknown) return state;
  const hierarchy::ElementId parent = elements_.at(e).parent;
  state = parent.valid() ? this->state(parent) : kSeen;
  if (state == kSeen && behind(e)) state = kHidden;
  known.store(state, std::memory_order_relaxed);  // whoever finds it finds the same
  return state;
}

/// Whether all that moves is behind a flat patch.
bool OutOfSight::behind(hierarchy::ElementId e) const {
  if (!elements_.isPatch(e) || !elements_.at(e).flat) return false;
  const hierarchy::ElementGeometry& g = elements_.shape(e);
  const Vec3 n(g.normal);
  return glm::dot(region_.center() - Vec3(g.center), n) + glm::dot(0.5 * region_.extent(), glm::abs(n)) < 0;
}

}  // namespace deltalux::paper
