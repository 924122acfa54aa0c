#include "radiosity/exposure.hpp"

#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

constexpr int kFewPoints = 16, kManyPoints = 64;  // of a leaf: at first, and when some are covered
constexpr int kRays = 4;                          // of a point, all of which must meet sides without an element

}  // namespace

Exposure::Exposure(const Scene& scene, const Elements& elements, const RayTracer& tracer)
    : scene_(scene), elements_(elements), tracer_(tracer), locator_(elements, scene) {}

float Exposure::of(ElementId leaf) const {
  const std::uint64_t key = combineKeys(elements_.key[leaf.index()], 7);
  int hidden = 0, points = 0;
  const auto look = [&](int most) {
    for (; points < most; ++points) {
      const auto u = stratified4(key, points);
      const PatchPoint p = samplePatch(elements_, scene_, leaf, u[0], u[1]);
      hidden += covered(p.position, p.normal, combineKeys(key, static_cast<std::uint64_t>(points)));
    }
  };
  look(kFewPoints);
  if (hidden == 0) return 1.0f;
  look(kManyPoints);
  return hidden == points ? 1.0f : static_cast<float>(points - hidden) / static_cast<float>(points);
}

bool Exposure::covered(const Vec3f& p, const Vec3f& normal, std::uint64_t key) const {
  const Frame frame{Vec3(normal)};
  for (int k = 0; k < kRays; ++k) {
    const auto u = stratified4(key, k);
    const Vec3f w(cosineDirection(frame, u[0], u[1]));
    Ray ray;
    ray.origin = offsetOrigin(p, normal, w);
    ray.direction = w;
    const Hit hit = tracer_.closestHit(ray);
    if (!hit || !std::holds_alternative<Opaque>(scene_.materialOf(hit.primitive).surface)) return false;
    if (locator_.side(hit.primitive, hit.triangle, hit.front).valid()) return false;
  }
  return true;
}

}  // namespace deltalux
