#include "lines/cover.hpp"

#include "lines/tuning.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::lines {

namespace {

float reachAt(const Vec3f& p) { return tuning::kContact * 1e-6f * std::max(tracing::largestCoordinate(p), 1e-6f); }

std::vector<BoxF> boxesOf(const Scene& scene) {
  std::vector<BoxF> boxes;
  for (const Primitive& p : scene.primitives) {
    const Box b = bounds(p.shape);
    BoxF box;
    if (!b.empty()) box.lower = Vec3f(b.lower), box.upper = Vec3f(b.upper);
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

Cover::Cover(const Scene& scene, const tracing::RayTracer& tracer)
    : scene_(scene), tracer_(tracer), boxes_(boxesOf(scene)) {}

bool Cover::mayTouch(const hierarchy::Elements& elements, hierarchy::ElementId leaf) const {
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  const float reach = reachAt(glm::max(glm::abs(g.lower), glm::abs(g.upper)));
  bool found = false;
  boxes_.overlapping({g.lower - reach, g.upper + reach}, [&](std::uint32_t i) {
    found = found || PrimitiveId(i) != elements.domain[leaf.index()].primitive;
  });
  return found;
}

bool Cover::covers(const Vec3f& p, const Vec3f& normal, PrimitiveId own) const {
  const float reach = reachAt(p);
  tracing::Ray ray;
  ray.origin = p + reach * normal, ray.direction = -normal, ray.tFar = 2 * reach;
  const tracing::Hit hit = tracer_.closestHit(ray);
  return hit && hit.primitive != own && scene::stopsLight(scene_.materialOf(hit.primitive));
}

}  // namespace deltalux::lines
