#include <algorithm>
#include <cmath>
#include <deltalux/scene.hpp>

#include "base/check.hpp"

namespace deltalux {

namespace {

/// Distance from the origin to that of the half of the scene that lies closest together, from which coordinates are
/// large: of 24 binary digits they leave 20 to tell places in the scene apart.
constexpr double kFar = 16;  // [rounding]

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

struct Weighted {
  double value, weight;
};

/// The value that half of the weight lies below.
double median(std::vector<Weighted> all) {
  std::sort(all.begin(), all.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double total = 0, below = 0;
  for (const Weighted& w : all) total += w.weight;
  for (const Weighted& w : all)
    if ((below += w.weight) >= 0.5 * total) return w.value;
  return all.back().value;
}

/// Where the parts of a scene are: surfaces by their size, and lights where there is nothing else.
struct Part {
  Vec3 center;
  double size;
};

std::vector<Part> namedParts(const Scene& scene) {
  std::vector<Part> parts;
  for (const Primitive& primitive : scene.primitives)
    if (const Box box = bounds(primitive.shape); !box.empty()) parts.push_back({box.center(), box.diagonal()});
  if (!parts.empty()) return parts;
  for (const Light& light : scene.lights)
    std::visit(
        [&](const auto& emitter) {
          if constexpr (requires { emitter.position; }) parts.push_back({emitter.position, 1.0});
        },
        light.emitter);
  return parts;
}

void shift(Vec3& p, const Vec3& by) { p -= by; }
void shift(Polygon& s, const Vec3& by) {
  for (Vec3& v : s.vertices) shift(v, by);
  shift(s.origin, by);
}
void shift(Sphere& s, const Vec3& by) { shift(s.center, by); }
void shift(Cylinder& s, const Vec3& by) { shift(s.p0, by), shift(s.p1, by); }
void shift(Cone& s, const Vec3& by) { shift(s.p0, by), shift(s.p1, by); }
void shift(Ring& s, const Vec3& by) { shift(s.center, by); }
void shift(Mesh& s, const Vec3& by) {
  for (Vec3& p : s.positions) shift(p, by);
}

}  // namespace

Vec3 fittingOrigin(const Scene& scene) {
  const std::vector<Part> parts = namedParts(scene);
  if (parts.empty()) return Vec3(0);
  Vec3 middle(0);
  std::vector<Weighted> all(parts.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < parts.size(); ++i) all[i] = {parts[i].center[axis], parts[i].size};
    middle[axis] = median(all);
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    all[i] = {largest(parts[i].center - middle) + 0.5 * parts[i].size, parts[i].size};
  const double reach = median(all);
  if (!(largest(middle) > kFar * reach) || !std::isfinite(largest(middle))) return scene.origin;
  // In steps of a power of two near the reach: coordinates with as few digits stay exact.
  const double step = std::exp2(std::ceil(std::log2(reach)));
  return scene.origin + step * glm::round(middle / step);
}

void moveOrigin(Scene& scene, const Vec3& origin) {
  const Vec3 by = origin - scene.origin;
  if (by == Vec3(0)) return;
  DELTALUX_CHECK(scene.placements.empty(), "a scene gets its origin before any edit");
  for (Primitive& primitive : scene.primitives) std::visit([&](auto& shape) { shift(shape, by); }, primitive.shape);
  for (Light& light : scene.lights)
    std::visit(
        [&](auto& emitter) {
          if constexpr (requires { emitter.position; }) shift(emitter.position, by);
        },
        light.emitter);
  for (View& view : scene.views) shift(view.position, by);
  scene.origin = origin;
}

View inScene(const Scene& scene, View view) {
  view.position -= scene.origin;
  return view;
}

}  // namespace deltalux
