// The Embree tracer against its brute-force twin: a million rays over every kind of primitive and nasty geometry.
#include <gtest/gtest.h>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "tracing/ray_tracer.hpp"
#include "tracing/test_scenes.hpp"

namespace deltalux {
using namespace tracing;

namespace {

constexpr std::size_t kRays = 85000;

/// Distance of the ray's line from the segment ab.
double distanceFromSegment(const Ray& ray, const Vec3& a, const Vec3& b) {
  const Vec3 d = glm::normalize(Vec3(ray.direction)), o(ray.origin);
  const Vec3 p = (a - o) - glm::dot(a - o, d) * d, q = (b - o) - glm::dot(b - o, d) * d;
  const double along = glm::clamp(-glm::dot(p, q - p) / glm::dot(q - p, q - p), 0.0, 1.0);
  return glm::length(p + along * (q - p));
}

/// Distance of the ray's line from the edges of the polygon, or of the mesh's triangle; infinite for other shapes.
double distanceFromEdges(const Shape& shape, std::uint32_t triangle, const Ray& ray) {
  std::vector<Vec3> outline;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) outline = polygon->vertices;
  if (const auto* mesh = std::get_if<Mesh>(&shape))
    for (const std::uint32_t corner : mesh->triangles[triangle]) outline.push_back(mesh->positions[corner]);
  double nearest = kInfinity;
  for (std::size_t i = 0; i < outline.size(); ++i)
    nearest = std::min(nearest, distanceFromSegment(ray, outline[i], outline[(i + 1) % outline.size()]));
  return nearest;
}

class Agreement : public testing::TestWithParam<test::NamedScene> {
 protected:
  void SetUp() override {
    box_ = bounds(scene());
    const Vec3 far = glm::max(glm::abs(box_.lower), glm::abs(box_.upper));
    size_ = std::max({far.x, far.y, far.z});
    Rng rng(31);
    rays_.resize(kRays);
    for (Ray& ray : rays_) ray = test::randomRay(scene(), box_, rng);
  }

  const Scene& scene() const { return GetParam().scene; }

  /// What rounding to single precision leaves open in t, seen along a grazing ray.
  double slack(const Hit& hit, const Ray& ray) const {
    const double cosine = std::abs(glm::dot(hit.normal, ray.direction));
    return 4e-7 * (size_ + hit.t) / std::max(cosine, 1e-6);
  }

  bool agree(const Hit& a, const Hit& b, const Ray& ray) const {
    if (!a || !b) return bool(a) == bool(b);
    if (std::abs(a.t - b.t) > slack(b, ray)) return false;
    if (GetParam().ties) return true;
    return a.primitive == b.primitive && a.triangle == b.triangle && a.front == b.front &&
           glm::dot(a.normal, b.normal) > 0.999f && glm::distance(a.position, b.position) < slack(b, ray);
  }

  /// Whether the ray passes an edge of what either tracer hit so closely that single precision cannot tell the side.
  bool grazesEdge(const Hit& a, const Hit& b, const Ray& ray) const {
    const auto grazes = [&](const Hit& hit) {
      const double rounding = 3e-7 * (size_ + glm::length(ray.origin) + hit.t);
      return hit && distanceFromEdges(scene()[hit.primitive].shape, hit.triangle, ray) < rounding;
    };
    return grazes(a) || grazes(b);
  }

  Box box_;
  double size_ = 0;  // largest coordinate
  std::vector<Ray> rays_;
};

TEST_P(Agreement, ClosestHits) {
  const auto embree = makeEmbreeTracer(scene()), bruteForce = makeBruteForceTracer(scene());
  std::vector<Hit> ours(kRays), theirs(kRays);
  embree->closestHits(rays_, ours);
  bruteForce->closestHits(rays_, theirs);
  RareEvent atEdges, elsewhere;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const bool differ = !agree(ours[i], theirs[i], rays_[i]);
    const bool edge = differ && grazesEdge(ours[i], theirs[i], rays_[i]);
    atEdges.observe(differ && edge);
    elsewhere.observe(differ && !edge);
    hits += theirs[i] ? 1 : 0;
  }
  EXPECT_FALSE(elsewhere.exceeds(1e-6)) << elsewhere.count();
  EXPECT_FALSE(atEdges.exceeds(GetParam().edgeRate)) << atEdges.count();
  EXPECT_GT(hits, kRays / 10) << "rays that hit nothing test nothing";
}

TEST_P(Agreement, SegmentsThatEndBeforeAndBehindTheHit) {
  const auto embree = makeEmbreeTracer(scene()), bruteForce = makeBruteForceTracer(scene());
  RareEvent disagreement;
  for (std::size_t i = 0; i < kRays; i += 8) {
    Ray ray = rays_[i];
    const Hit hit = bruteForce->closestHit(ray);
    if (!hit) {
      disagreement.observe(embree->occluded(ray));
      continue;
    }
    const auto reach = static_cast<float>(slack(hit, ray));
    if (!(reach < 0.1f * hit.t)) continue;
    ray.tFar = hit.t + reach;
    disagreement.observe(!embree->occluded(ray) || !isBlack(embree->transmittance(ray)));
    ray.tFar = hit.t - reach;
    disagreement.observe(embree->occluded(ray) || embree->transmittance(ray) != Rgb(1.0f));
  }
  EXPECT_FALSE(disagreement.exceeds(1e-5)) << disagreement.count();
  EXPECT_GT(disagreement.total(), kRays / 100);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(test::nastyScenes()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace deltalux
