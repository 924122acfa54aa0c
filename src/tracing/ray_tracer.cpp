#include "tracing/ray_tracer.hpp"

#include "base/check.hpp"
#include "base/parallel.hpp"

namespace deltalux::tracing {

namespace {
constexpr std::size_t kOcclusionBlock = 1024;  // rays: enough to hide the scheduling, few enough to balance [task]
}

std::uint64_t RayTracer::traced() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t ofThread : traced_) sum += ofThread;
  return sum;
}

void RayTracer::closestHits(std::span<const Ray> rays, std::span<Hit> hits) const {
  DELTALUX_CHECK(rays.size() == hits.size(), "one hit per ray");
  parallelFor(rays.size(), kOcclusionBlock, [&](std::size_t i) { hits[i] = closestHit(rays[i]); });
}

void RayTracer::transmittances(std::span<const Ray> rays, std::span<Rgb> results) const {
  DELTALUX_CHECK(rays.size() == results.size(), "one result per ray");
  parallelFor(rays.size(), kOcclusionBlock, [&](std::size_t i) { results[i] = transmittance(rays[i]); });
}

void RayTracer::passings(std::span<const Ray> rays, std::span<Passing> results) const {
  DELTALUX_CHECK(rays.size() == results.size(), "one result per ray");
  const auto one = [&](std::size_t i) { results[i] = passing(rays[i]); };
  // A few rays are done before a task would have begun.
  if (rays.size() > kOcclusionBlock) return parallelFor(rays.size(), kOcclusionBlock, one);
  for (std::size_t i = 0; i < rays.size(); ++i) one(i);
}

}  // namespace deltalux::tracing
