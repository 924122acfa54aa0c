#include "mesh_pick.hpp"

#include <algorithm>

namespace deltalux::viewer {

namespace {

/// Where the ray enters the box; nothing: it passes by, or the box lies behind.
std::optional<double> enters(const Box& box, const Vec3& origin, const Vec3& inverse) {
  double near = 0, far = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.lower[axis] - origin[axis]) * inverse[axis];
    const double b = (box.upper[axis] - origin[axis]) * inverse[axis];
    near = std::fmax(near, std::fmin(a, b)), far = std::fmin(far, std::fmax(a, b));  // that leave NaN out
  }
  return near <= far ? std::optional(near) : std::nullopt;
}

struct TriangleHit {
  double distance = 0;
  Vec3 weights{0};  // of the corners
};

/// Möller and Trumbore's test, for triangles that face the ray.
std::optional<TriangleHit> meets(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& origin,
                                 const Vec3& direction) {
  const Vec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (!(determinant > 0)) return std::nullopt;
  const Vec3 from = origin - a;
  const double u = glm::dot(from, p) / determinant;
  const Vec3 q = glm::cross(from, ab);
  const double v = glm::dot(direction, q) / determinant, distance = glm::dot(ac, q) / determinant;
  constexpr double kSeam = 1e-6;  // single precision of the corners leaves no gaps between triangles
  if (u < -kSeam || v < -kSeam || u + v > 1 + kSeam || !(distance > 0)) return std::nullopt;
  return TriangleHit{distance, {1 - u - v, u, v}};
}

/// The point of a curved shape that the triangle stands for.
void moveOntoShape(SurfaceHit& hit, const Shape& shape) {
  if (std::holds_alternative<Polygon>(shape) || std::holds_alternative<Mesh>(shape)) return;
  const SurfacePoint on = pointAt(shape, parameterAt(shape, hit.position));
  hit.position = on.position;
  hit.normal = hit.front ? on.normal : -on.normal;
}

}  // namespace

void MeshPick::follow(std::shared_ptr<const SolutionMesh> mesh) {
  mesh_ = std::move(mesh);
  sides_.resize(mesh_->surfaces.size());
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const SurfaceMesh* surface = mesh_->surfaces[i].get();
    if (!surface) {
      sides_[i] = {};
    } else if (sides_[i].version != surface->shapeVersion) {
      sides_[i] = {{}, surface->shapeVersion};
      for (const MeshVertex& v : surface->vertices) sides_[i].box.extend(Vec3(v.position));
    }
  }
}

std::optional<MeshHit> MeshPick::first(const Vec3& origin, const Vec3& direction,
                                       const std::optional<Box>& within) const {
  if (!mesh_) return std::nullopt;
  const Vec3 inverse = 1.0 / direction;
  std::optional<MeshHit> best;
  double nearest = kInfinity;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (sides_[i].box.empty()) continue;
    const std::optional<double> at = enters(sides_[i].box, origin, inverse);
    if (!at || *at > nearest) continue;
    const SurfaceMesh& surface = *mesh_->surfaces[i];
    for (std::size_t t = 0; t + 2 < surface.triangles.size(); t += 3) {
      const MeshVertex* corners[3];
      for (std::size_t k = 0; k < 3; ++k) corners[k] = &surface.vertices[surface.triangles[t + k]];
      const Vec3 a(corners[0]->position), b(corners[1]->position), c(corners[2]->position);
      const std::optional<TriangleHit> hit = meets(a, b, c, origin, direction);
      if (!hit || !(hit->distance < nearest)) continue;
      const Vec3 position = origin + hit->distance * direction;
      if (within && !within->contains(position)) continue;
      nearest = hit->distance;
      best.emplace();
      best->surface = {surface.primitive, surface.front, position, glm::normalize(glm::cross(b - a, c - a)), nearest};
      for (int k = 0; k < 3; ++k)
        best->irradiance += float(hit->weights[k]) * (corners[k]->direct + corners[k]->indirect + corners[k]->particle);
    }
  }
  if (best) moveOntoShape(best->surface, (*mesh_->scene)[best->surface.primitive].shape);
  return best;
}

}  // namespace deltalux::viewer
