#pragma once
// Where walls stand on a flat surface. Light changes all at once along their feet (discontinuities of degree zero
// [LTG93]), and a patch on both sides of a wall has one radiosity: what falls on it outside would shine inside. So
// patches are split along such lines rather than in their middle. A patch is a rectangle of its plane, and so are its
// parts: only lines along either axis of the plane count, as those of most houses do.
//
// Lines are those of the scene that was solved, with everything at rest: edits change none, so that a scene that was
// edited is split as it was before.
#include <cstdint>
#include <deltalux/scene.hpp>
#include <optional>
#include <vector>

namespace deltalux::hierarchy {

class Elements;

class ContactLines {
 public:
  ContactLines() = default;
  /// On and of the surfaces below the scene's root. Cost: a tree of boxes over them all, and a query of it a surface.
  ContactLines(const Elements&, const Scene&);

  /// A patch's rectangle: its plane, [from,to] along the axis that is asked for, [low,high] along the other.
  struct Range {
    std::uint32_t plane;
    int axis;  // 0: u, 1: v
    float from, to, low, high;
  };
  /// Where to split the rectangle: at the line nearest to its middle that crosses at least half of it, well inside, and
  /// whose wall rises by `height` or more [m]. Nothing where none does.
  std::optional<float> across(const Range&, float height) const;
  std::size_t memoryBytes() const;

 private:
  struct Line {
    float at;        // parameter along the axis that it stands across
    float from, to;  // along the other
    float height;    // by which the wall rises over the surface [m]
  };
  class Search;

  std::vector<Line> lines_;         // of one plane and axis after the other, by `at`
  std::vector<std::uint32_t> end_;  // of the lines of plane i / 2, axis i % 2
};

}  // namespace deltalux::hierarchy
