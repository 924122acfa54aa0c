#pragma once
// A side of a surface cut into pieces that are drawn as they are: leaf patches, parts of those where the surface is
// curved and leaves are too large to look round, and what has no patches at all (lamps, panes, sides in the dark).
//
// Pieces lie in a space of their own, in which edges are straight: flat ones in the world, curved ones in the
// parameters of their shape, as (u, v, 0). Curved pieces are cut along lines that depend on the shape alone, so pieces
// of two leaves meet in whole edges, but for the corners that touching_points.hpp inserts.
#include <optional>
#include <span>

#include "hierarchy/element.hpp"

namespace deltalux::rendering {

struct SurfacePiece {
  hierarchy::ElementId leaf;  // none: nothing is known of light here
  std::uint32_t triangle = 0, plane = 0;
  std::uint32_t first = 0, count = 0;  // its corners in SurfacePieces::corners
  Vec2 center{0};
  bool cut = false;                 // a part of its leaf ...
  Vec2 leafLower{0}, leafUpper{1};  // ... which has these parameters (curved)
};

struct SurfacePieces {
  PrimitiveId primitive;
  bool front = true, flat = true;
  std::vector<SurfacePiece> all;
  std::vector<Vec2> corners;                  // (u,v), counter-clockwise in them
  std::vector<hierarchy::PlaneFrame> planes;  // of flat pieces
  std::optional<Mat4> lag;                    // as lagOf()

  std::span<const Vec2> cornersOf(const SurfacePiece& p) const { return {corners.data() + p.first, p.count}; }
  /// In the space of the pieces.
  Vec3 place(const SurfacePiece& p, const Vec2& uv) const { return flat ? planes[p.plane].at(uv) : Vec3(uv, 0); }
};

/// Into how many parts a curved surface is cut all the way round, for it to look round in a scene of that size; 0 for
/// flat ones.
int stepsRound(const Shape&, double sceneSize);

/// The leaves of a side, in the order of its pieces.
std::vector<hierarchy::ElementId> leavesOf(const hierarchy::Elements&, const Scene&, PrimitiveId, bool front);

/// In motion a flat surface is where the hand has it before its patches follow: the map from it to them; nullopt where
/// they are one.
std::optional<Mat4> lagOf(const hierarchy::Elements&, const Scene&, PrimitiveId, bool front);

/// None where a side has no extent, or nobody can see it: the inside of a ball that no light reaches. Follows from the
/// shape, the steps and the leaves. Cost: a visit per leaf.
SurfacePieces piecesOf(const hierarchy::Elements&, const Scene&, PrimitiveId, bool front);

}  // namespace deltalux::rendering
