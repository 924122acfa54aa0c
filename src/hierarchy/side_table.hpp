#pragma once
// Which input-level element stands for a side of a surface: what a ray has met is looked up in two loads, and what is
// asked of a few sides costs nothing of the others. Cost: 8 bytes a primitive, 4 a side.
#include <deltalux/scene.hpp>
#include <tuple>
#include <vector>

#include "hierarchy/element_id.hpp"

namespace deltalux {

/// A side of a surface, or of a mesh's triangle.
struct Side {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;
  bool front = true;

  bool operator==(const Side&) const = default;
  /// By surface, fronts before backs.
  friend bool operator<(const Side& a, const Side& b) {
    return std::tuple(a.primitive, a.triangle, !a.front) < std::tuple(b.primitive, b.triangle, !b.front);
  }
};

class SideTable {
 public:
  /// The element of a side that has none yet.
  void add(const Side&, ElementId);
  /// Invalid where the side has none.
  ElementId at(const Side&) const;

  /// visit(element) of all sides of a primitive, in the order of triangles.
  template <class Visit>
  void forEachOf(PrimitiveId primitive, const Visit& visit) const {
    if (primitive.index() >= ranges_.size()) return;
    const Range& r = ranges_[primitive.index()];
    for (std::uint32_t i = 0; i < r.count; ++i)
      if (sides_[r.first + i].valid()) visit(sides_[r.first + i]);
  }
  std::size_t memoryBytes() const;

 private:
  struct Range {
    std::uint32_t first = 0, count = 0;  // in sides_: front and back of triangle after triangle
  };

  std::vector<Range> ranges_;  // by primitive
  std::vector<ElementId> sides_;
};

}  // namespace deltalux
