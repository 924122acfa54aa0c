#include <deltalux/material.hpp>
#include <deltalux/probe.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

namespace {
/// Follows `ray` through panes to the first surface that is none.
std::optional<ProbePoint> firstSurface(const Scene& scene, const tracing::RayTracer& tracer, tracing::Ray ray) {
  constexpr int kMostPanes = 64;  // [limit]
  for (int pane = 0; pane <= kMostPanes; ++pane) {
    const tracing::Hit hit = tracer.closestHit(ray);
    if (!hit) return std::nullopt;
    const Vec3f position = hit.position;
    if (!isPane(scene.materialOf(hit.primitive)))
      return ProbePoint{Vec3(position), Vec3(hit.front ? hit.normal : -hit.normal)};
    ray.origin = tracing::offsetOrigin(position, hit.normal, ray.direction);
  }
  return std::nullopt;
}
}  // namespace

std::vector<std::optional<ProbePoint>> visiblePoints(const Scene& scene, const View& view, int width, int height) {
  DELTALUX_CHECK(width > 0 && height > 0, "a view needs pixels");
  const std::unique_ptr<tracing::RayTracer> tracer = tracing::makeEmbreeTracer(scene);
  std::vector<std::optional<ProbePoint>> points(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  parallelFor(points.size(), 256, [&](std::size_t i) {
    const double x = (static_cast<double>(i % width) + 0.5) / width,
                 y = (static_cast<double>(i / width) + 0.5) / height;
    const ViewRay seen = viewRay(view, x, y);
    tracing::Ray ray;
    ray.origin = Vec3f(seen.origin);
    ray.direction = Vec3f(seen.direction);
    points[i] = firstSurface(scene, *tracer, ray);
  });
  return points;
}

}  // namespace deltalux
