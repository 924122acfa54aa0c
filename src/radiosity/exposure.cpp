#include "radiosity/exposure.hpp"

#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "paper/sender_sampling.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::radiosity {

namespace {

constexpr int kFewPoints = 8;                 // of a leaf, at first
constexpr int kManyPoints = 64;               // when something may cover some,
constexpr std::size_t kInAll = 1 << 18;       // and up to 1024 where leaves are few
constexpr int kLeafLines = 6;                 // across a flat leaf, either way
constexpr float kLow = 1e-3f, kHigh = 3e-2f;  // of them above it, by turns, in its radii: under what hangs close
constexpr int kRays = 4;  // of a point, all of which must meet sides without an element when those are far

}  // namespace

Exposure::Exposure(const Scene& scene, const hierarchy::Elements& elements, const tracing::RayTracer& tracer)
    : scene_(scene), elements_(elements), tracer_(tracer), points_(kManyPoints) {
  std::size_t leaves = 0;  // as far as it matters
  for (std::size_t i = 0; i < elements.size() && leaves * kManyPoints < kInAll; ++i)
    leaves += elements.isReceivingLeaf(hierarchy::ElementId(i));
  while (points_ < 16 * kManyPoints && static_cast<std::size_t>(points_) * leaves < kInAll) points_ *= 2;
}

float Exposure::of(hierarchy::ElementId leaf) const {
  const std::uint64_t key = combineKeys(elements_.key[leaf.index()], 7);
  const auto isCovered = [&](int i) {
    const auto u = paper::stratified4(key, i);
    const hierarchy::PatchPoint p = hierarchy::samplePatch(elements_, scene_, leaf, u[0], u[1]);
    return covered(p.position, p.normal, elements_.shape(leaf).radius, combineKeys(key, static_cast<std::uint64_t>(i)));
  };
  const auto count = [&](int first, int end) {
    int hidden = 0;
    for (int i = first; i < end; ++i) hidden += isCovered(i);
    return hidden;
  };
  // What finds that something may stand here must not weigh in how much it covers.
  if (!stoodUpon(leaf) && count(0, kFewPoints) == 0) return 1.0f;
  const int hidden = count(kFewPoints, kFewPoints + points_);
  return hidden == points_ ? 1.0f : static_cast<float>(points_ - hidden) / static_cast<float>(points_);
}

/// Whether any of some lines closely over the leaf meets something: they find a table's foot that points would miss.
bool Exposure::stoodUpon(hierarchy::ElementId leaf) const {
  if (!elements_.at(leaf).flat) return false;
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  const hierarchy::PatchDomain& d = elements_.domain[leaf.index()];
  const auto meets = [&](float height, double u0, double v0, double u1, double v1) {
    const hierarchy::PatchPoint a = hierarchy::pointOn(elements_, scene_, leaf, u0, v0),
                                b = hierarchy::pointOn(elements_, scene_, leaf, u1, v1);
    const Vec3f up = height * g.radius * g.normal;
    return tracer_.occluded(tracing::segment(a.position + up, Vec3f(0.0f), b.position + up, Vec3f(0.0f)));
  };
  for (int i = 0; i < kLeafLines; ++i) {
    const double at = (i + 0.5) / kLeafLines, u = d.u0 + at * (d.u1 - d.u0), v = d.v0 + at * (d.v1 - d.v0);
    const float height = i % 2 == 0 ? kLow : kHigh;
    if (meets(height, d.u0, v, d.u1, v) || meets(height, u, d.v0, u, d.v1)) return true;
  }
  return false;
}

bool Exposure::covered(const Vec3f& p, const Vec3f& normal, float near, std::uint64_t key) const {
  const Frame frame{Vec3(normal)};
  for (int k = 0; k < kRays; ++k) {
    const auto u = paper::stratified4(key, k);
    const Vec3f w(cosineDirection(frame, u[0], u[1]));
    tracing::Ray ray;
    ray.origin = tracing::offsetOrigin(p, normal, w);
    ray.direction = w;
    const tracing::Hit hit = tracer_.closestHit(ray);
    if (!hit || !scene::stopsLight(scene_.materialOf(hit.primitive))) return false;
    if (elements_.side(hit.primitive, hit.triangle, hit.front).valid()) return false;
    if (hit.t < near) return true;
  }
  return true;
}

}  // namespace deltalux::radiosity
