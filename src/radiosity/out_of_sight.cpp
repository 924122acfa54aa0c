#include "radiosity/out_of_sight.hpp"

#include "radiosity/separation.hpp"

namespace deltalux {

OutOfSight::OutOfSight(const Elements& elements, const Scene& scene, const RayTracer& tracer, const Box& region)
    : elements_(elements),
      scene_(scene),
      tracer_(tracer),
      region_(region),
      corners_(cornersOf(region.lower, region.upper)),
      size_(elements.size()),
      state_(std::make_unique<std::atomic<std::uint32_t>[]>(elements.size())) {}

PrimitiveId OutOfSight::occluder(ElementId e) const {
  const std::uint32_t found = state(e);
  return found < kFirst ? PrimitiveId() : PrimitiveId(found - kFirst);
}

std::uint32_t OutOfSight::state(ElementId e) const {
  while (e.index() >= size_) e = elements_.at(e).parent;  // it was split since
  std::atomic<std::uint32_t>& known = state_[e.index()];
  std::uint32_t state = known.load(std::memory_order_relaxed);
  if (state != kUnknown) return state;
  const ElementId parent = elements_.at(e).parent;
  state = parent.valid() ? this->state(parent) : kSeen;
  if (state == kSeen) state = find(e);
  known.store(state, std::memory_order_relaxed);  // whoever finds it finds the same
  return state;
}

std::uint32_t OutOfSight::find(ElementId e) const {
  if (elements_.isDistant(e)) return kSeen;
  const ElementGeometry& g = elements_.shape(e);
  if (behind(e)) return kBehind;
  if (region_.overlaps({Vec3(g.lower), Vec3(g.upper)})) return kSeen;
  std::array<Vec3, kMostCorners> corners;
  const std::size_t count = cornersOf(elements_, e, corners);
  return alongRay(e, std::span(corners).first(count));
}

std::uint32_t OutOfSight::alongRay(ElementId e, std::span<const Vec3> corners) const {
  constexpr int kMost = 6;          // surfaces along the ray
  constexpr float kBeyond = 1e-5f;  // of its length: from one surface on to the next
  const ElementGeometry& g = elements_.shape(e);
  const Vec3f from = elements_.isPatch(e) ? g.center : 0.5f * (g.lower + g.upper);
  Ray ray = segment(from, g.normal, Vec3f(0.5 * (region_.lower + region_.upper)), Vec3f(0.0f));
  const float beyond = kBeyond * ray.tFar;
  for (int i = 0; i < kMost; ++i) {
    const Hit hit = tracer_.closestHit(ray);
    if (!hit) return kSeen;
    const Polygon* p = opaque(hit.primitive);
    if (p && separates({p->origin, p->edgeU, p->edgeV, p->normal}, p->outline, corners, corners_))
      return kFirst + hit.primitive.value;
    ray.tNear = hit.t + beyond;
  }
  return kSeen;
}

/// Whether all that moves is behind a flat patch.
bool OutOfSight::behind(ElementId e) const {
  if (!elements_.isPatch(e) || !elements_.at(e).flat) return false;
  const ElementGeometry& g = elements_.shape(e);
  const Vec3 n(g.normal);
  return glm::dot(region_.center() - Vec3(g.center), n) + glm::dot(0.5 * region_.extent(), glm::abs(n)) < 0;
}

const Polygon* OutOfSight::opaque(PrimitiveId id) const {
  return isThinGlass(scene_.materialOf(id)) ? nullptr : std::get_if<Polygon>(&scene_[id].shape);
}

}  // namespace deltalux
