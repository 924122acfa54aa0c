#pragma once
// The dynamic octree around an object in motion [GD01 4.1]. Where the object is, cells are subdivided down to a share
// of its size; elsewhere they are as large as that leaves them. Every cell that is not subdivided knows the links of
// which some particle's path crosses it. When the object is held elsewhere, cells gain it and lose it; those that no
// longer need to be subdivided are simplified [GD01 4.2].
//
// The object is the boxes of its surfaces. A path crosses a cell when one of its segments does, from its origin on;
// cells and object are grown by a margin that covers by how much rays start and end off what they join.
// (Departure: a cell that holds the object before and after is changed too, as the object's surface has moved within
// it; without that a path that hits the object elsewhere would stay as it was.)
// Cost: some ten nanoseconds a segment and cell that it crosses. Memory: 40 bytes a cell, 5 to 11 a link in it.
#include <span>
#include <vector>

#include "paper/link_table.hpp"
#include "particles/particles.hpp"

namespace deltalux::paper {

struct OctreeSettings {
  double finest = 0.125;  // side of the smallest cells that the object is in, of the object's largest extent
};

/// What a motion did to the cells that hold the object, or held it.
struct OctreeChange {
  std::vector<std::uint32_t> links;  // that cross them, ascending
  std::size_t gained = 0, lost = 0, kept = 0;
};

class Octree {
 public:
  /// Around what is at `object`, with the links of all paths. `margin`: by which things may be off their boxes.
  Octree(const particles::Particles&, const Box& scene, std::span<const Box> object, double margin,
         const OctreeSettings& = {});

  /// Subdivides around the object where it is now, and simplifies where it was [GD01 4.2]. Paths must be those that
  /// were registered. False when it has left the octree, which is then as it was.
  bool hold(const particles::Particles&, std::span<const Box> object, OctreeChange&);

  /// Takes the path of a link out of the cells that its vertices cross, and puts it in. A link is in a cell once,
  /// however many of its paths cross it: take all out before one is put in.
  void erase(const particles::Particles&, std::uint32_t link, std::span<const Vec3f> vertices);
  void insert(const particles::Particles&, std::uint32_t link, std::span<const Vec3f> vertices);

  std::size_t cells() const;
  std::size_t memoryBytes() const;
  /// Recounts: every cell knows all links whose paths cross it, and no others, to a part of the margin; cells around
  /// the object are as small as they are to be. Throws std::logic_error.
  void validate(const particles::Particles&) const;

 private:
  struct Cell {
    std::uint32_t firstChild = 0;  // of eight; 0: not subdivided
    LinkTable links;               // of a cell that is not subdivided
  };
  /// A cube.
  struct Place {
    Vec3 lower{0};
    double side = 0;
    int depth = 0;

    Box box() const { return {lower, lower + side}; }
    Place child(std::uint32_t i) const;
  };
  using Boxes = std::vector<Box>;

  Boxes touching(const Place&, const Boxes&) const;
  std::uint32_t allocate();
  void split(std::uint32_t cell, const Place&, const particles::Particles&);
  void simplify(std::uint32_t cell, const particles::Particles&);
  void hold(std::uint32_t cell, const Place&, const Boxes& before, const Boxes& now, const particles::Particles&,
            OctreeChange*);
  template <class Visit>
  void crossed(std::uint32_t cell, const Place&, double margin, const Vec3f& a, const Vec3f& b,
               const Visit& visit) const;
  template <class Visit>
  void forPath(std::span<const Vec3f> vertices, double margin, const Visit& visit) const;
  using LinksOfCells = std::vector<std::vector<std::uint32_t>>;
  LinksOfCells crossings(const particles::Particles&, double margin) const;
  void validateCells() const;

  Place root_;
  double margin_ = 0;
  int deepest_ = 0;  // of cells that hold the object
  Boxes object_;     // grown by the margin
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> free_;  // first cells of eight that are not in use
};

}  // namespace deltalux::paper
