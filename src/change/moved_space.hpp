#pragma once
// Where an edit has moved surfaces from and to: what a ray has found is what it would find now, unless it starts there
// or passes there. [GD01 4.1: the shafts of links against boxes, here for each line]
#include <array>
#include <deltalux/edit.hpp>
#include <span>
#include <vector>

#include "base/box_tree.hpp"
#include "hierarchy/element.hpp"

namespace deltalux::change {

class MovedSpace {
 public:
  MovedSpace() = default;
  /// Of the scene as it is now.
  MovedSpace(const Scene&, std::span<const SceneChange::Moved>);

  /// A surface more that is not what it was.
  void add(PrimitiveId, const BoxF&);

  bool empty() const { return boxes_.empty(); }
  bool moved(PrimitiveId p) const { return p.index() < moved_.size() && moved_[p.index()]; }
  /// Boxes that hold all of them: of where surfaces were and where they are, one where these are near each other, and
  /// of what was added.
  std::span<const BoxF> around() const { return around_; }
  static constexpr std::size_t kMostAround = 3;  // [layout]
  /// Whether all of them lie behind a plane: what starts there and runs to where the normal points meets none.
  bool behind(const Vec3f& point, const Vec3f& normal) const;
  /// Whether one of the boxes and this one have a point in common.
  bool touches(const BoxF&) const;
  /// Whether a line may pass one that starts anywhere in `from` and runs along `direction`, of any length, for so long
  /// (infinite as well); it may go astray by `stray` of the way.
  bool crosses(const BoxF& from, const Vec3f& direction, float length, float stray = 0) const;
  /// Whether a segment between points of two boxes may pass one.
  bool between(const BoxF& a, const BoxF& b) const;

 private:
  /// A line from anywhere in a box.
  struct Line {
    Vec3f from, half;  // the middle of the box, and half its size
    Vec3f halfUnit;    // the line's direction
    float length, stray;

    /// A box, by its middle and half its size.
    bool misses(float x, float y, float z, float halfX, float halfY, float halfZ) const;
    bool misses(const BoxF&) const;
  };
  /// Boxes side by side, by their middle and half their size: as many as vectors hold, the last one repeated.
  struct Row {
    static constexpr std::size_t kBoxes = 8;  // [layout]

    void put(const BoxF&);
    bool crosses(const Line&) const;

    using Each = std::array<float, kBoxes>;
    Each x, y, z, halfX, halfY, halfZ;
    std::size_t count = 0;
  };
  using Rows = std::vector<Row>;

  void hold(std::span<const BoxF> group);
  /// Into the last group.
  void put(const BoxF&);

  float margin_ = 0;
  BoxF all_;
  std::vector<BoxF> boxes_;   // few
  std::vector<BoxF> around_;  // groups of them
  std::vector<Rows> rows_;    // of each group
  bool added_ = false;        // whether the last group is of what was added
  std::vector<char> moved_;   // by primitive
};

}  // namespace deltalux::change
