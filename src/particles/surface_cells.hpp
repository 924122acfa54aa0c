#pragma once
// Surfaces cut into cells of about equal area by halving the longer side of a unit square, as long as a cell is larger
// than a limit. Cells are named by the halves taken, so they do not depend on where their surface is.
#include <deltalux/scene.hpp>
#include <vector>

namespace deltalux::particles {

/// A rectangle of a unit square: of a surface's parameters, of its frame, or of the numbers that sample it.
struct UnitRect {
  double u0 = 0, v0 = 0, u1 = 1, v1 = 1;

  Vec2 at(const Vec2& s) const { return {u0 + s.x * (u1 - u0), v0 + s.y * (v1 - v0)}; }
  double measure() const { return (u1 - u0) * (v1 - v0); }
};

struct UnitCell {
  UnitRect rect;
  std::uint32_t code = 0;  // the halves taken, from the highest bit down
};

inline constexpr int kMostHalvings = 16;  // [layout]

/// How often a surface of `area` is halved until cells have at most `limit`.
int halvings(double area, double limit);
/// The 2^halvings cells of a surface of world size `size` along u and v, ascending by code.
std::vector<UnitCell> cellsOf(const Vec2& size, int halvings);
/// Which of them holds `p`.
std::uint32_t cellAt(const Vec2& size, int halvings, const Vec2& p);

/// World lengths along the two numbers that samplePoint() takes, good enough to halve the longer one.
Vec2 sampleSize(const Shape&);

/// The two numbers from which samplePoint() makes the point at parameters `uv` (of the triangle, for meshes).
Vec2 sampleNumbers(const Shape&, std::uint32_t triangle, const Vec2& uv);

/// The power of two below `x`: thresholds made of it do not move with small edits.
double coarse(double x);

/// The object at the top of the tree that a primitive belongs to; primitives without one are their own.
std::vector<std::uint32_t> topObjects(const Scene&);

}  // namespace deltalux::particles
