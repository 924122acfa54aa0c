#pragma once
// What is known of sides of surfaces, by side: what a ray has met is looked up in two loads, and what is asked of a few
// sides costs nothing of the others. Cost: 8 bytes a primitive, and a value a side.
#include <algorithm>
#include <deltalux/scene.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace deltalux::hierarchy {

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

template <class T>
class SideTable {
 public:
  /// The value of a side, T() at first; makes room for it.
  T& add(const Side& side) {
    if (side.primitive.index() >= ranges_.size()) ranges_.resize(side.primitive.index() + 1);
    Range& r = ranges_[side.primitive.index()];
    const std::uint32_t place = placeOf(side);
    if (place >= r.count) {  // moves to where there is room
      const Range wider{static_cast<std::uint32_t>(values_.size()), std::max(2 * (side.triangle + 1), 2 * r.count)};
      values_.resize(wider.first + wider.count);
      std::copy_n(values_.begin() + r.first, r.count, values_.begin() + wider.first);
      r = wider;
    }
    return values_[r.first + place];
  }
  /// Null where there is no room for the side.
  T* find(const Side& side) { return const_cast<T*>(std::as_const(*this).find(side)); }
  const T* find(const Side& side) const {
    if (side.primitive.index() >= ranges_.size()) return nullptr;
    const Range& r = ranges_[side.primitive.index()];
    const std::uint32_t place = placeOf(side);
    return place < r.count ? &values_[r.first + place] : nullptr;
  }
  /// T() where there is nothing.
  T at(const Side& side) const {
    const T* value = find(side);
    return value ? *value : T();
  }

  /// visit(value) of all sides of a primitive that are not T(), in the order of triangles.
  template <class Visit>
  void forEachOf(PrimitiveId primitive, const Visit& visit) const {
    if (primitive.index() >= ranges_.size()) return;
    const Range& r = ranges_[primitive.index()];
    for (std::uint32_t i = 0; i < r.count; ++i)
      if (values_[r.first + i] != T()) visit(values_[r.first + i]);
  }
  std::size_t memoryBytes() const { return ranges_.capacity() * sizeof(Range) + values_.capacity() * sizeof(T); }

 private:
  struct Range {
    std::uint32_t first = 0, count = 0;  // in values_: front and back of triangle after triangle
  };
  static std::uint32_t placeOf(const Side& s) { return 2 * s.triangle + (s.front ? 0 : 1); }

  std::vector<Range> ranges_;  // by primitive
  std::vector<T> values_;
};

}  // namespace deltalux::hierarchy
