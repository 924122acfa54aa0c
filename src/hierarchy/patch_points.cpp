// Points of patches, and directions of parts of the sky.
#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/unit_circle.hpp"
#include "hierarchy/outline.hpp"
#include "hierarchy/patch.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux::hierarchy {

namespace {
/// Uniform by area over the unit square.
PatchPoint onFace(const Mesh& mesh, std::uint32_t face, const Vec2& uniform, bool front) {
  const auto& [a, b, c] = mesh.triangles[face];
  const Vec3 &p = mesh.positions[a], e1 = mesh.positions[b] - p, e2 = mesh.positions[c] - p;
  const Vec2 at = scene::kinds::uniformInTriangle(uniform);
  const Vec3 n = glm::normalize(glm::cross(e1, e2));
  return {Vec3f(p + at.x * e1 + at.y * e2), Vec3f(front ? n : -n)};
}
}  // namespace

PatchPoint pointOn(const Elements& elements, const Scene& scene, ElementId patch, double u, double v) {
  const PatchDomain& d = elements.domain[patch.index()];
  const bool front = elements.at(patch).front;
  if (elements.at(patch).flat) {
    const PlaneFrame& f = elements.frames[d.frame];
    return {Vec3f(f.at({u, v})), Vec3f(front ? f.normal : -f.normal)};
  }
  if (elements.hasFaces(patch)) {
    const auto& mesh = std::get<Mesh>(scene[d.primitive].shape);
    const FaceOrder::Share share = elements.orderOf(patch).at(elements.facesOf(patch), u);
    return onFace(mesh, elements.orderOf(patch).faceAt(share.place), {share.rest, v}, front);
  }
  const SurfacePoint p = pointAt(scene[d.primitive].shape, {u, v});
  return {Vec3f(p.position), Vec3f(front ? p.normal : -p.normal)};
}

namespace {
/// The parameter below which lies the share `b` of a cone's area between v0 and v1: its radius grows linearly.
double byArea(const Cone& cone, double v0, double v1, double b) {
  const auto radius = [&](double v) { return cone.radius0 + v * (cone.radius1 - cone.radius0); };
  const double r0 = radius(v0), r1 = radius(v1);
  if (std::abs(r1 - r0) < 1e-9 * std::max(r0, r1)) return v0 + b * (v1 - v0);
  const double r = std::sqrt(r0 * r0 + b * (r1 * r1 - r0 * r0));
  return v0 + (v1 - v0) * std::clamp((r - r0) / (r1 - r0), 0.0, 1.0);
}
}  // namespace

bool fillsItsRectangle(const Elements& elements, ElementId patch) {
  if (!elements.at(patch).flat) return false;
  const PatchDomain& d = elements.domain[patch.index()];
  const double du = d.u1 - d.u0, dv = d.v1 - d.v0;
  return outlineFills(elements.outline(patch), du * dv);
}

PatchPoint samplePatch(const Elements& elements, const Scene& scene, ElementId patch, double a, double b) {
  const PatchDomain& d = elements.domain[patch.index()];
  const double du = d.u1 - d.u0, dv = d.v1 - d.v0;
  if (!elements.at(patch).flat) {
    const auto* cone = std::get_if<Cone>(&scene[d.primitive].shape);
    return pointOn(elements, scene, patch, d.u0 + a * du, cone ? byArea(*cone, d.v0, d.v1, b) : d.v0 + b * dv);
  }
  const auto outline = elements.outline(patch);
  const bool full = outlineFills(outline, du * dv);
  Vec2 uv{d.u0 + a * du, d.v0 + b * dv};
  if (!full && !outlineContains(outline, uv)) {
    // Rejection keeps samples uniform; the sequence depends on (a,b) alone.
    Rng rng(combineKeys(static_cast<std::uint64_t>(a * 0x1p53), static_cast<std::uint64_t>(b * 0x1p53)));
    for (int attempt = 0; attempt < 64; ++attempt) {
      uv = {d.u0 + rng.uniform() * du, d.v0 + rng.uniform() * dv};
      if (outlineContains(outline, uv)) break;
      if (attempt == 63) uv = glm::mix(outlineCentroid(outline), outline[0], 0.5);
    }
  }
  return pointOn(elements, scene, patch, uv.x, uv.y);
}

Vec3f directionOf(const Elements& elements, const Scene& scene, ElementId e, double a, double b) {
  const auto& emitter = scene[elements.light[e.index()]].emitter;
  Vec3 axis;
  double halfAngle;
  if (const auto* sun = std::get_if<SunLight>(&emitter)) {
    axis = sun->direction, halfAngle = sun->angularRadius;
  } else {
    const auto& dome = std::get<DomeLight>(emitter);
    axis = dome.axis, halfAngle = dome.halfAngle;
  }
  const PatchDomain& d = elements.domain[e.index()];
  // 1 - cos, so that the sun's small cap keeps its precision.
  const double cap = 2 * std::pow(std::sin(0.5 * halfAngle), 2) * (d.v0 + b * (d.v1 - d.v0));
  const double sine = std::sqrt(std::max(0.0, cap * (2 - cap)));
  return Vec3f(Frame(axis).toWorld(Vec3(sine * onUnitCircle(d.u0 + a * (d.u1 - d.u0)), 1 - cap)));
}

}  // namespace deltalux::hierarchy
