#include <algorithm>
#include <deltalux/shape.hpp>
#include <type_traits>

#include "scene/shape_kinds.hpp"

namespace deltalux {

double area(const Shape& shape) {
  return std::visit([](const auto& s) { return scene::kinds::area(s); }, shape);
}

Box bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return scene::kinds::bounds(s); }, shape);
}

SurfacePoint pointAt(const Shape& shape, Vec2 uv) {
  return std::visit([&](const auto& s) { return scene::kinds::pointAt(s, uv); }, shape);
}

Vec2 parameterAt(const Shape& shape, const Vec3& p, std::uint32_t triangle) {
  return std::visit(
      [&]<class Kind>(const Kind& s) {
        if constexpr (std::is_same_v<Kind, Mesh>)
          return scene::kinds::parameterAt(s, p, triangle);
        else
          return scene::kinds::parameterAt(s, p);
      },
      shape);
}

bool covers(const Shape& shape, Vec2 uv) {
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return false;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return scene::kinds::covers(*polygon, uv);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return scene::kinds::covers(*mesh, uv);
  return true;
}

SurfacePoint samplePoint(const Shape& shape, Vec2 uniform) {
  return std::visit([&](const auto& s) { return scene::kinds::samplePoint(s, uniform); }, shape);
}

std::optional<Shape> transformed(const Shape& shape, const Mat4& matrix) {
  const scene::kinds::ShapeMap map(matrix);
  return std::visit([&](const auto& s) { return scene::kinds::transformed(s, map); }, shape);
}

std::size_t tessellatedPolygonCount(const Shape& shape) {
  constexpr std::size_t around = 24, down = 12;
  if (std::holds_alternative<Polygon>(shape)) return 1;
  if (std::holds_alternative<Sphere>(shape)) return around * down;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->triangles.size();
  return around;
}

}  // namespace deltalux

namespace deltalux::scene {

namespace kinds {

ShapeMap::ShapeMap(const Mat4& matrix)
    : linear(glm::dmat3(matrix)), translation(matrix[3]), mirrors(glm::determinant(linear) < 0) {
  constexpr double tolerance = 1e-5;  // matrices read from single precision
  const glm::dmat3 gram = glm::transpose(linear) * linear;
  const double squared = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  double deviation = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) deviation = std::max(deviation, std::abs(gram[i][j] - (i == j ? squared : 0.0)));
  if (squared > 0 && std::isfinite(squared) && deviation <= tolerance * squared) scale = std::sqrt(squared);
}

double turnOf(double x, double y) {
  const double turn = std::atan2(y, x) / (2 * kPi);
  const double wrapped = turn < 0 ? turn + 1 : turn;
  return wrapped < 1 ? wrapped : 0.0;
}

Box circleBounds(const Vec3& center, const Vec3& normal, double radius) {
  const Vec3 half = radius * glm::sqrt(glm::max(Vec3(1) - normal * normal, Vec3(0)));
  return {center - half, center + half};
}

Choice choose(const std::vector<double>& cumulative, double uniform) {
  const double target = uniform * cumulative.back();
  const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, target);
  const double below = found == cumulative.begin() ? 0.0 : *(found - 1);
  const double remainder = (target - below) / (*found - below);
  return {static_cast<std::uint32_t>(found - cumulative.begin()), std::clamp(remainder, 0.0, 1.0)};
}

Vec2 uniformInTriangle(Vec2 uniform) {
  // Each half of the square, cut along its diagonal, is sheared onto half of the triangle: near stays near.
  if (uniform.y > uniform.x) return {0.5 * uniform.x, uniform.y - 0.5 * uniform.x};
  return {uniform.x - 0.5 * uniform.y, 0.5 * uniform.y};
}

}  // namespace kinds

}  // namespace deltalux::scene
