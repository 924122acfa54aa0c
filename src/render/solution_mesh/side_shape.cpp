#include "render/solution_mesh/side_shape.hpp"

#include <algorithm>

#include "hierarchy/outline.hpp"
#include "hierarchy/plane_points.hpp"
#include "render/solution_mesh/touching_points.hpp"
#include "scene/triangulation.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kThin = 1e-9;                   // of a piece's area: a fan's triangle has more [rounding]
constexpr double kOnBorder = 1e-5;               // of a curved surface's parameters [rounding]
constexpr std::uint32_t kNoPoint = 0xffffffffu;  // [sentinel]

bool fanFits(const std::vector<Vec2>& ring, const Vec2& center) {
  const double least = kThin * hierarchy::outlineArea(ring);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - center, b = ring[(i + 1) % ring.size()] - center;
    if (!(a.x * b.y - a.y * b.x > least)) return false;
  }
  return true;
}

/// Makes one side's shape, piece by piece.
class SideMaker {
 public:
  SideMaker(const SurfacePieces& pieces, const Scene& scene, const TouchingPoints& points)
      : pieces_(pieces), shape_(scene[pieces.primitive].shape), mesh_(std::get_if<Mesh>(&shape_)), points_(points) {
    made_->primitive = pieces.primitive, made_->front = pieces.front, made_->lag = pieces.lag;
    vertexOf_.assign(points.size(), kNoPoint);
  }

  void add(const SurfacePiece& piece, std::span<const std::uint32_t> ring) {
    SideShape::Part part;
    part.leaf = piece.leaf;
    part.triangles = count(made_->triangles), part.outlines = count(made_->outlines);
    uv_.clear(), vertices_.clear();
    for (const std::uint32_t p : ring) {
      uv_.push_back(parametersOf(piece, points_.at(p)));
      vertices_.push_back(vertexAt(piece, p, uv_.back()));
    }
    const std::size_t n = ring.size();
    if (n == 3 || (!pieces_.flat && n == 4)) {
      for (std::size_t i = 1; i + 1 < n; ++i) addTriangle(vertices_[0], vertices_[i], vertices_[i + 1]);
    } else if (fanFits(uv_, piece.center) && (piece.leaf.valid() || !pieces_.flat)) {
      const std::uint32_t center = addVertex(vertexFor(piece, pieces_.place(piece, piece.center), piece.center));
      for (std::size_t i = 0; i < n; ++i) addTriangle(center, vertices_[i], vertices_[(i + 1) % n]);
    } else {
      for (const auto& [a, b, c] : scene::triangulate(uv_)) addTriangle(vertices_[a], vertices_[b], vertices_[c]);
    }
    if (piece.leaf.valid()) addOutline(piece);
    part.trianglesEnd = count(made_->triangles), part.outlinesEnd = count(made_->outlines);
    made_->parts.push_back(part);
  }

  std::shared_ptr<const SideShape> done() { return std::move(made_); }

 private:
  static std::uint32_t count(const std::vector<std::uint32_t>& v) { return static_cast<std::uint32_t>(v.size()); }

  Vec2 parametersOf(const SurfacePiece& piece, const Vec3& p) const {
    return pieces_.flat ? hierarchy::PlanePoints(pieces_.planes[piece.plane]).of(p) : Vec2(p);
  }

  MeshVertex vertexFor(const SurfacePiece& piece, const Vec3& place, const Vec2& uv) const {
    MeshVertex v;
    v.uv = glm::vec2(uv);
    if (!pieces_.flat) {
      const SurfacePoint p = pointAt(shape_, {uv.x >= 1 ? uv.x - 1 : uv.x, uv.y});  // the seam is one line
      v.position = Vec3f(p.position), v.normal = Vec3f(p.normal);
    } else {
      v.position = Vec3f(place), v.normal = Vec3f(pieces_.planes[piece.plane].normal);
      if (mesh_) shade(v, piece.triangle, uv);
    }
    if (!pieces_.front) v.normal = -v.normal;
    return v;
  }

  /// A mesh's own normals and texture coordinates.
  void shade(MeshVertex& v, std::uint32_t triangle, const Vec2& uv) const {
    const auto& [a, b, c] = mesh_->triangles[triangle];
    const auto within = [&](const auto& values) {
      return (1 - uv.x - uv.y) * values[a] + uv.x * values[b] + uv.y * values[c];
    };
    v.uv = mesh_->texcoords.empty() ? glm::vec2(0.0f) : glm::vec2(within(mesh_->texcoords));
    if (mesh_->normals.empty()) return;
    const Vec3 n = within(mesh_->normals);
    if (const double length = glm::length(n); length > 1e-6) v.normal = Vec3f(n / length);
  }

  std::uint32_t addVertex(const MeshVertex& v) {
    made_->points.push_back(v);
    nextAtPoint_.push_back(kNoPoint);
    return static_cast<std::uint32_t>(made_->points.size() - 1);
  }

  /// The side's vertex at a point: one for all pieces, but where a mesh has several normals or textures there.
  std::uint32_t vertexAt(const SurfacePiece& piece, std::uint32_t point, const Vec2& uv) {
    constexpr float kSame = 1e-4f;  // [rounding]
    std::uint32_t& first = vertexOf_[point];
    if (!mesh_ && first != kNoPoint) return first;
    const MeshVertex v = vertexFor(piece, points_.at(point), uv);
    for (std::uint32_t i = first; i != kNoPoint; i = nextAtPoint_[i]) {
      const MeshVertex& other = made_->points[i];
      if (glm::length(other.normal - v.normal) < kSame && glm::length(other.uv - v.uv) < kSame) return i;
    }
    const std::uint32_t added = addVertex(v);
    nextAtPoint_[added] = first;
    return vertexOf_[point] = added;
  }

  /// Corners counter-clockwise in (u,v); triangles without area, at poles, are left out.
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const MeshVertex &va = made_->points[a], &vb = made_->points[b], &vc = made_->points[c];
    if (va.position == vb.position || vb.position == vc.position || vc.position == va.position) return;
    const Vec3f n = glm::cross(vb.position - va.position, vc.position - va.position);
    const bool turned = pieces_.flat ? !pieces_.front : glm::dot(n, va.normal + vb.normal + vc.normal) < 0;
    if (turned) std::swap(b, c);
    made_->triangles.insert(made_->triangles.end(), {a, b, c});
  }

  /// The ring just added, less what is inside of its leaf.
  void addOutline(const SurfacePiece& piece) {
    for (std::size_t i = 0; i < uv_.size(); ++i) {
      const std::size_t next = (i + 1) % uv_.size();
      if (piece.cut && !onBorder(piece, uv_[i], uv_[next])) continue;
      made_->outlines.insert(made_->outlines.end(), {vertices_[i], vertices_[next]});
    }
  }
  bool onBorder(const SurfacePiece& piece, const Vec2& a, const Vec2& b) const {
    for (int axis = 0; axis < 2; ++axis)
      for (const double border : {piece.leafLower[axis], piece.leafUpper[axis]})
        if (std::abs(a[axis] - border) < kOnBorder && std::abs(b[axis] - border) < kOnBorder) return true;
    return false;
  }

  const SurfacePieces& pieces_;
  const Shape& shape_;
  const Mesh* mesh_;
  const TouchingPoints& points_;
  std::shared_ptr<SideShape> made_ = std::make_shared<SideShape>();
  std::vector<std::uint32_t> vertexOf_;     // by point: the last vertex there
  std::vector<std::uint32_t> nextAtPoint_;  // by vertex: another one at its point
  std::vector<Vec2> uv_;                    // of the ring at work
  std::vector<std::uint32_t> vertices_;
};

/// A closed surface's seam has both of its sides' points on it.
void addSeam(TouchingPoints& points) {
  for (std::size_t i = 0, n = points.size(); i < n; ++i) {
    const Vec3 p = points.at(static_cast<std::uint32_t>(i));
    if (p.x <= 0) points.add(p + Vec3(1, 0, 0));
    if (p.x >= 1) points.add(p - Vec3(1, 0, 0));
  }
}

}  // namespace

std::vector<std::shared_ptr<const SideShape>> shapesOf(const std::vector<const SurfacePieces*>& sides,
                                                       const Scene& scene, double touching) {
  TouchingPoints points(touching);
  TouchingPoints::Rings rings;
  for (const SurfacePieces* side : sides)
    for (const SurfacePiece& piece : side->all) {
      for (const Vec2& uv : side->cornersOf(piece)) {
        const std::uint32_t point = points.add(side->place(piece, uv));
        if (rings.points.size() == rings.begin.back() || rings.points.back() != point) rings.points.push_back(point);
      }
      if (rings.points.size() > rings.begin.back() + 1 && rings.points.back() == rings.points[rings.begin.back()])
        rings.points.pop_back();
      rings.close();
    }
  if (!sides.empty() && !sides.front()->flat) addSeam(points);
  if (rings.size() > 1) rings = points.withTouching(rings);

  std::vector<std::shared_ptr<const SideShape>> shapes;
  std::size_t ring = 0;
  for (const SurfacePieces* side : sides) {
    SideMaker maker(*side, scene, points);
    for (const SurfacePiece& piece : side->all) {
      const std::span<const std::uint32_t> corners(rings.points.data() + rings.begin[ring],
                                                   rings.begin[ring + 1] - rings.begin[ring]);
      if (corners.size() >= 3) maker.add(piece, corners);
      ++ring;
    }
    shapes.push_back(maker.done());
  }
  return shapes;
}

}  // namespace deltalux::rendering
