#pragma once
// Whether a segment meets one of a few surfaces, generously: never false where a ray tracer might find a hit. Surfaces
// are thickened by a margin, and split into pieces (triangles, or whole curved surfaces) in a tree of boxes.
// Cost: 3 nanoseconds for a segment off the boxes, 10 to 20 a piece whose box it meets.
#include <deltalux/shape.hpp>
#include <span>
#include <variant>

#include "particles/segment_box.hpp"

namespace deltalux::particles {

class MovedShapes {
 public:
  /// Surfaces without extent are left out.
  MovedShapes(std::span<const Shape* const>, double margin);

  bool empty() const { return pieces_.empty(); }
  /// Cheap and generous: whether the segment comes near any of them.
  bool near(const Vec3f& a, const Vec3f& b) const { return !nodes_.empty() && nodes_[0].box.meets(a, b); }
  bool meets(const Vec3f& a, const Vec3f& b) const;

 private:
  /// A part of the plane dot(normal, p) = offset within some edges: dot(edge[i], p) <= bound[i].
  struct Facet {
    Vec3 normal;
    double offset = 0;
    Vec3 edges[3];
    double bounds[3] = {0, 0, 0};
  };
  /// A cylinder or cone frustum; the radius at the foot, and its growth per length.
  struct Barrel {
    Vec3 foot, axis;
    double height = 0, radius = 0, slope = 0;
  };
  using Piece = std::variant<Facet, Barrel, Sphere, Ring>;
  struct Node {
    SegmentBox box;
    std::uint32_t begin = 0, end = 0;  // pieces
    std::uint32_t second = 0;          // child, behind the first, which follows its parent; 0: none
  };
  using Boxed = std::pair<Box, Piece>;

  static void addPieces(const Shape&, std::vector<Boxed>&);
  static Facet facet(const Vec3&, const Vec3&, const Vec3&);
  void build(std::vector<Boxed>&, std::size_t begin, std::size_t end);

  bool meets(const Facet&, const Vec3& a, const Vec3& b) const;
  bool meets(const Barrel&, const Vec3& a, const Vec3& b) const;
  bool meets(const Sphere&, const Vec3& a, const Vec3& b) const;
  bool meets(const Ring&, const Vec3& a, const Vec3& b) const;

  double margin_;
  std::vector<Node> nodes_;
  std::vector<Piece> pieces_;
};

}  // namespace deltalux::particles
