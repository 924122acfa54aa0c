#include <algorithm>

#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

namespace {

constexpr double kRounding = 1e-12;  // [rounding]

bool finiteMap(const Mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

const Placement* placementOf(const Scene& scene, PrimitiveId primitive) {
  const auto at = std::lower_bound(scene.placements.begin(), scene.placements.end(), primitive,
                                   [](const Placement& p, PrimitiveId id) { return p.primitive < id; });
  return at != scene.placements.end() && at->primitive == primitive ? &*at : nullptr;
}

}  // namespace

Mat4 withoutRounding(const Mat4& matrix, const Scene& scene) {
  const Vec3 far = glm::abs(scene.origin);
  const double size = std::max({1.0, far.x, far.y, far.z});
  double deviation = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      deviation = std::max(deviation, std::abs(matrix[c][r] - (c == r ? 1.0 : 0.0)) / (c == 3 ? size : 1.0));
  return finiteMap(matrix) && deviation <= kRounding ? Mat4(1.0) : matrix;
}

Mat4 between(const Mat4& matrix, const Vec3& from, const Vec3& to) {
  Mat4 result = matrix;
  result[3] += glm::dvec4(glm::dmat3(matrix) * from - to, 0);
  return result;
}

bool isDark(const Light& light) {
  const auto* point = std::get_if<PointLight>(&light.emitter);
  return point && isBlack(point->intensity);
}

Shape removedShape() { return Mesh{}; }

const Shape& restShape(const Scene& scene, PrimitiveId primitive) {
  const Placement* placement = placementOf(scene, primitive);
  return placement ? placement->rest : scene[primitive].shape;
}

Restore::PrimitiveState stateOf(const Scene& scene, PrimitiveId primitive) {
  const Placement* placement = placementOf(scene, primitive);
  Restore::PrimitiveState state{primitive, scene[primitive].material, Mat4(1.0), true};
  if (placement) state.matrix = placement->matrix, state.present = placement->present;
  return state;
}

Restore::LightState stateOf(const Scene& scene, LightId light) {
  const auto waiting = std::find_if(scene.switchedOff.begin(), scene.switchedOff.end(),
                                    [&](const SwitchedOff& s) { return s.light == light; });
  return {light, scene[light], waiting == scene.switchedOff.end() ? std::nullopt : std::optional<Rgb>(waiting->scale)};
}

Shape shapeOf(const Scene& scene, const Restore::PrimitiveState& state, const Shape& rest) {
  if (!state.present) return removedShape();
  if (state.matrix == Mat4(1.0)) return rest;
  const Mat4& m = state.matrix;
  if (!finiteMap(m) || m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    refuse("the matrix is no affine map", "its last row is 0 0 0 1");
  std::optional<Shape> shape = transformed(rest, m);
  if (shape) return std::move(*shape);
  const bool known = state.primitive.index() < scene.primitives.size() && scene[state.primitive].object.valid();
  refuse("the map would shear or flatten " +
             (known ? "'" + scene[scene[state.primitive].object].name + "'" : std::string("a surface")),
         "spheres, cylinders, cones and rings can be moved, turned and scaled evenly");
}

}  // namespace deltalux::scene::edits
