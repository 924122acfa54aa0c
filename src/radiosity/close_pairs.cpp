#include "radiosity/close_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "hierarchy/outline.hpp"
#include "tracing/analytic_surface.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kClose = 2.0f;                   // in radii of both ends, between their centres
constexpr int kUniform = kClosePairs / 2;        // candidates that are
constexpr int kCosine = kClosePairs - kUniform;  // and those in cosine directions

double kernelBetween(const hierarchy::PatchPoint& x, const hierarchy::PatchPoint& y) {
  const Vec3 d = Vec3(y.position) - Vec3(x.position);
  const double squared = glm::dot(d, d), cosX = glm::dot(Vec3(x.normal), d), cosY = -glm::dot(Vec3(y.normal), d);
  return cosX > 0 && cosY > 0 && squared > 0 ? cosX * cosY / (kPi * squared * squared) : 0.0;
}

/// Where a ray from above meets a flat patch.
std::optional<hierarchy::PatchPoint> meetFlat(const hierarchy::Elements& elements, hierarchy::ElementId patch,
                                              const Vec3& origin, const Vec3& w) {
  const hierarchy::PatchDomain& d = elements.domain[patch.index()];
  const hierarchy::PlaneFrame& f = elements.frames[d.frame];
  const Vec3 n = elements.at(patch).front ? f.normal : -f.normal;
  const double towards = glm::dot(w, n);
  if (!(towards < 0)) return std::nullopt;
  const double t = glm::dot(f.origin - origin, n) / towards;
  if (!(t > 0)) return std::nullopt;
  const Vec3 p = origin + t * w, from = p - f.origin;
  const double uu = glm::dot(f.edgeU, f.edgeU), vv = glm::dot(f.edgeV, f.edgeV), uv = glm::dot(f.edgeU, f.edgeV);
  const double pu = glm::dot(from, f.edgeU), pv = glm::dot(from, f.edgeV), det = uu * vv - uv * uv;
  const Vec2 at{(pu * vv - pv * uv) / det, (pv * uu - pu * uv) / det};
  if (at.x < d.u0 || at.x > d.u1 || at.y < d.v0 || at.y > d.v1) return std::nullopt;
  const auto outline = elements.outline(patch);
  const double whole = double(d.u1 - d.u0) * double(d.v1 - d.v0);
  if (!hierarchy::outlineFills(outline, whole) && !hierarchy::outlineContains(outline, at)) return std::nullopt;
  return hierarchy::PatchPoint{Vec3f(p), Vec3f(n)};
}

template <class Surface>
std::optional<hierarchy::PatchPoint> meetCurved(const Surface& surface, const Shape& shape,
                                                const hierarchy::PatchDomain& d, double side, const Vec3& origin,
                                                const Vec3& w) {
  const tracing::Crossings crossings = surface.crossings(origin, w);
  for (int i = 0; i < crossings.count; ++i) {
    const double t = crossings.t[static_cast<std::size_t>(i)];
    if (!(t > 0)) continue;
    const Vec3 p = origin + t * w, n = side * surface.normal(p);
    if (!(glm::dot(w, n) < 0)) continue;
    const Vec2 at = parameterAt(shape, p);
    if (at.x >= d.u0 && at.x <= d.u1 && at.y >= d.v0 && at.y <= d.v1) return hierarchy::PatchPoint{Vec3f(p), Vec3f(n)};
  }
  return std::nullopt;
}

/// Where a ray meets a patch on its side.
std::optional<hierarchy::PatchPoint> meet(const hierarchy::Elements& elements, const Scene& scene,
                                          hierarchy::ElementId patch, const Vec3& origin, const Vec3& w) {
  if (elements.at(patch).flat) return meetFlat(elements, patch, origin, w);
  const hierarchy::PatchDomain& d = elements.domain[patch.index()];
  const Shape& shape = scene[d.primitive].shape;
  const double side = elements.at(patch).front ? 1.0 : -1.0;
  const auto on = [&](const auto& surface) { return meetCurved(surface, shape, d, side, origin, w); };
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return on(tracing::SphereSurface(*sphere));
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return on(tracing::CylinderSurface(*cylinder));
  if (const auto* cone = std::get_if<Cone>(&shape)) return on(tracing::ConeSurface(*cone));
  return on(tracing::RingSurface(std::get<Ring>(shape)));
}

}  // namespace

bool areClose(const hierarchy::Elements& elements, hierarchy::ElementId a, hierarchy::ElementId b) {
  const hierarchy::ElementGeometry &x = elements.shape(a), &y = elements.shape(b);
  const Vec3f d = x.center - y.center;
  const float reach = kClose * (x.radius + y.radius);
  return glm::dot(d, d) < reach * reach;
}

ClosePair closePair(const hierarchy::Elements& elements, const Scene& scene, const hierarchy::PatchPoint& from,
                    hierarchy::ElementId patch, int i, double a, double b) {
  const hierarchy::ElementGeometry& g = elements.shape(patch);
  ClosePair pair{from, {}, 0};
  if (i < kUniform) {
    pair.to = hierarchy::samplePatch(elements, scene, patch, a, b);
  } else {
    const auto to = meet(elements, scene, patch, Vec3(from.position), cosineDirection(Frame(Vec3(from.normal)), a, b));
    if (!to) return pair;
    pair.to = *to;
  }
  const double K = kernelBetween(from, pair.to);
  pair.weight = K / (kUniform / double(g.area) + kCosine * K);  // [Veach97 9.2.2]
  return pair;
}

}  // namespace deltalux::radiosity
