#include "render/solution_mesh/surface_pieces.hpp"

#include <algorithm>

#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/outline.hpp"
#include "hierarchy/tuning.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kApart = 1e-5;  // of the parameters: cuts nearer to a border are left out [rounding]

double largestRadius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return cylinder->radius;
  if (const auto* cone = std::get_if<Cone>(&shape)) return std::max(cone->radius0, cone->radius1);
  if (const auto* ring = std::get_if<Ring>(&shape)) return ring->outerRadius;
  return 0;
}

/// Cuts of a curved surface, by parameter.
struct RoundCuts {
  std::vector<double> u, v;
};

RoundCuts roundCuts(const Shape& shape, double sceneSize) {
  RoundCuts cuts;
  const int steps = stepsRound(shape, sceneSize);
  for (int i = 1; i < steps; ++i) cuts.u.push_back(double(i) / steps);
  if (std::holds_alternative<Sphere>(shape))
    for (int j = 1; j < steps / 2; ++j) cuts.v.push_back(0.5 * (1 - std::cos(2 * kPi * j / steps)));
  return cuts;
}

std::vector<double> cutsWithin(const std::vector<double>& cuts, double low, double high) {
  std::vector<double> all{low};
  for (auto c = std::lower_bound(cuts.begin(), cuts.end(), low + kApart); c != cuts.end() && *c < high - kApart; ++c)
    all.push_back(*c);
  all.push_back(high);
  return all;
}

void addPiece(SurfacePieces& to, SurfacePiece piece, std::span<const Vec2> corners) {
  piece.first = static_cast<std::uint32_t>(to.corners.size());
  piece.count = static_cast<std::uint32_t>(corners.size());
  to.corners.insert(to.corners.end(), corners.begin(), corners.end());
  to.all.push_back(piece);
}

/// The leaf, or all of the surface, in parts.
void addRound(SurfacePieces& to, const RoundCuts& cuts, hierarchy::ElementId leaf, const Vec2& low, const Vec2& high) {
  const std::vector<double> u = cutsWithin(cuts.u, low.x, high.x), v = cutsWithin(cuts.v, low.y, high.y);
  SurfacePiece piece;
  piece.leaf = leaf;
  piece.leafLower = low, piece.leafUpper = high;
  piece.cut = u.size() > 2 || v.size() > 2;
  for (std::size_t j = 0; j + 1 < v.size(); ++j)
    for (std::size_t i = 0; i + 1 < u.size(); ++i) {
      const Vec2 corners[] = {{u[i], v[j]}, {u[i + 1], v[j]}, {u[i + 1], v[j + 1]}, {u[i], v[j + 1]}};
      piece.center = 0.5 * (corners[0] + corners[2]);
      addPiece(to, piece, corners);
    }
}

void addFlat(SurfacePieces& to, SurfacePiece piece, std::span<const Vec2> outline) {
  if (outline.size() < 3) return;
  piece.center = hierarchy::outlineCentroid(outline);
  addPiece(to, piece, outline);
}

/// The leaves under the sides' input-level patch, or all of a flat surface where it has none.
void addFlatSide(SurfacePieces& to, const hierarchy::Elements& elements, hierarchy::ElementId side,
                 std::uint32_t triangle, const hierarchy::PlaneFrame& plane, std::span<const Vec2> outline) {
  SurfacePiece piece;
  piece.triangle = triangle;
  piece.plane = static_cast<std::uint32_t>(to.planes.size());
  to.planes.push_back(plane);
  if (!side.valid()) {
    addFlat(to, piece, outline);
    return;
  }
  hierarchy::forEachLeafBelow(elements, side, [&](hierarchy::ElementId e) {
    piece.leaf = e;
    addFlat(to, piece, elements.hasFaces(e) ? outline : elements.outline(e));
  });
}

/// Whether a side is the inside of a ball.
bool isInside(const Shape& shape, bool front) {
  const auto* sphere = std::get_if<Sphere>(&shape);
  return sphere && front == sphere->inward;
}

}  // namespace

int stepsRound(const Shape& shape, double sceneSize) {
  const double radius = largestRadius(shape);
  if (!(radius > 0)) return 0;
  constexpr int kMost = 1 << 12;  // [limit]
  int steps = hierarchy::tuning::kGrid;
  while (steps < kMost && radius * (1 - std::cos(kPi / steps)) > tuning::kSagitta * sceneSize) steps *= 2;
  return steps;
}

std::vector<hierarchy::ElementId> leavesOf(const hierarchy::Elements& elements, const Scene& scene,
                                           PrimitiveId primitive, bool front) {
  std::vector<hierarchy::ElementId> leaves;
  const auto* mesh = std::get_if<Mesh>(&scene[primitive].shape);
  for (std::uint32_t t = 0; t < (mesh ? mesh->triangles.size() : 1); ++t)
    if (const hierarchy::ElementId side = elements.side(primitive, t, front); side.valid())
      hierarchy::forEachLeafBelow(elements, side, [&](hierarchy::ElementId e) { leaves.push_back(e); });
  sortUnique(leaves);  // some hold many triangles
  return leaves;
}

namespace {

hierarchy::PlaneFrame planeOf(const Polygon& p) { return {p.origin, p.edgeU, p.edgeV, p.normal}; }

hierarchy::PlaneFrame planeOf(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  hierarchy::PlaneFrame plane;
  plane.origin = mesh.positions[a];
  plane.edgeU = mesh.positions[b] - plane.origin, plane.edgeV = mesh.positions[c] - plane.origin;
  plane.normal = glm::normalize(glm::cross(plane.edgeU, plane.edgeV));
  return plane;
}

/// From the plane's parameters, and the distance in front of it in a length that scales with it.
Mat4 spaceOf(const hierarchy::PlaneFrame& p) {
  const double size = std::sqrt(glm::length(glm::cross(p.edgeU, p.edgeV)));
  return {{p.edgeU, 0}, {p.edgeV, 0}, {size * p.normal, 0}, {p.origin, 1}};
}

}  // namespace

std::optional<Mat4> lagOf(const hierarchy::Elements& elements, const Scene& scene, PrimitiveId primitive, bool front) {
  const auto* polygon = std::get_if<Polygon>(&scene[primitive].shape);
  const auto* mesh = std::get_if<Mesh>(&scene[primitive].shape);
  for (std::uint32_t t = 0; t < (mesh ? mesh->triangles.size() : polygon ? 1 : 0); ++t) {
    const hierarchy::ElementId side = elements.side(primitive, t, front);
    if (!side.valid() || elements.hasFaces(side)) continue;
    const hierarchy::PlaneFrame now = polygon ? planeOf(*polygon) : planeOf(*mesh, t),
                                patches = elements.frames[elements.domain[side.index()].frame];
    if (now.origin == patches.origin && now.edgeU == patches.edgeU && now.edgeV == patches.edgeV) return std::nullopt;
    return spaceOf(patches) * glm::inverse(spaceOf(now));
  }
  return std::nullopt;
}

SurfacePieces piecesOf(const hierarchy::Elements& elements, const Scene& scene, PrimitiveId primitive, bool front) {
  SurfacePieces result;
  result.primitive = primitive, result.front = front;
  result.lag = lagOf(elements, scene, primitive, front);
  const Shape& shape = scene[primitive].shape;
  if (!(area(shape) > 0)) return result;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    addFlatSide(result, elements, elements.side(primitive, 0, front), 0, planeOf(*polygon), polygon->outline);
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const Vec2 outline[] = {{0, 0}, {1, 0}, {0, 1}};
    for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t)
      addFlatSide(result, elements, elements.side(primitive, t, front), t, planeOf(*mesh, t), outline);
  } else {
    result.flat = false;
    const RoundCuts cuts = roundCuts(shape, elements.sceneBox.diagonal());
    const hierarchy::ElementId side = elements.side(primitive, 0, front);
    if (!side.valid() && isInside(shape, front)) return result;
    if (!side.valid()) {
      addRound(result, cuts, side, Vec2(0), Vec2(1));
      return result;
    }
    hierarchy::forEachLeafBelow(elements, side, [&](hierarchy::ElementId e) {
      const hierarchy::PatchDomain& d = elements.domain[e.index()];
      addRound(result, cuts, e, {d.u0, d.v0}, {d.u1, d.v1});
    });
  }
  return result;
}

}  // namespace deltalux::rendering
