#pragma once
// What particles are sent to: the surfaces that pass light on other than diffusely (mirrors, lobes, glass), cut into
// cells, in a tree of their own. Both sides of a surface are one receiver.
//
// Flat surfaces have cells of their plane's rectangle (what of it the surface leaves empty is simply never met), curved
// ones of their parameters. Cells and nodes of the tree are bounded by spheres. What cells there are, and how they are
// drawn, depends on the shapes as they were read; where they are, on where edits have put them. The sphere of a node
// follows its cells when all of them have moved; while some have not, it stays what it was at rest, and holds those: it
// only says where to look, and a thing that moves must not turn every look at what stands around it.
#include "particles/radix_tree.hpp"
#include "particles/solid_angle_rectangle.hpp"
#include "particles/surface_cells.hpp"
#include "tracing/ray.hpp"

namespace deltalux::particles {

struct BoundingSphere {
  Vec3 center{0};
  double radius = 0;  // negative: of nothing

  bool empty() const { return radius < 0; }
  bool operator==(const BoundingSphere&) const = default;
};

/// A point of a receiver with its unit front normal.
struct ReceiverPoint {
  Vec3 position{0}, normal{0, 0, 1};
};

class Receivers {
 public:
  explicit Receivers(const Scene&);
  enum class Motion : std::uint8_t { None, Below, Bound };
  /// Takes in where these primitives are now. Returns by node: something below it moved, and whether its bound did.
  std::vector<Motion> follow(std::span<const PrimitiveId>);

  bool empty() const { return cells_.empty(); }
  std::size_t size() const { return cells_.size(); }
  const std::vector<RadixNode>& nodes() const { return nodes_; }
  std::uint32_t root() const { return 0; }
  const BoundingSphere& bound(std::uint32_t node) const { return bounds_[node]; }
  /// Whether all below the node lies within that.
  bool holdsAll(std::uint32_t node) const { return holdsAll_[node]; }
  bool isFlat(std::uint32_t cell) const { return cells_[cell].flat; }
  PrimitiveId primitive(std::uint32_t cell) const { return surfaces_[cells_[cell].surface].primitive; }
  std::uint32_t triangle(std::uint32_t cell) const { return surfaces_[cells_[cell].surface].triangle; }
  /// Greatest specular reflectance or transmittance of the surface.
  float albedo(std::uint32_t cell) const { return surfaces_[cells_[cell].surface].albedo; }
  /// Area of the cell, 0 when the surface was removed: of a flat one with what the surface leaves empty of it.
  double area(std::uint32_t cell) const { return surfaces_[cells_[cell].surface].whole * cells_[cell].rect.measure(); }
  /// Weight by which a cell is drawn, area times albedo.
  double weight(std::uint32_t cell) const { return cumulative_[cell + 1] - cumulative_[cell]; }
  double weightOf(const RadixNode& node) const { return cumulative_[node.end] - cumulative_[node.begin]; }
  /// A cell below the node, drawn by weight; `u` in [0,1).
  std::uint32_t choose(const RadixNode& node, double u) const;

  /// The rectangle of a flat cell.
  Rectangle rectangle(std::uint32_t cell) const;
  /// The point of a flat cell at shares `s` of its rectangle; nullopt where the surface is not.
  std::optional<ReceiverPoint> flatPoint(std::uint32_t cell, const Vec3& position) const;
  /// A point of a curved cell, uniform by area.
  ReceiverPoint curvedPoint(std::uint32_t cell, const Vec2& u) const;

  /// The cell that holds the point a ray has hit; kNone when its surface receives no particles.
  std::uint32_t cellOf(const tracing::Hit&) const;

  std::size_t memoryBytes() const;

 private:
  struct Surface {
    PrimitiveId primitive;
    std::uint32_t triangle = 0;
    std::uint32_t firstCell = 0;
    int halvings = 0;
    float albedo = 0;
    Vec2 size{0};      // at rest
    double whole = 0;  // area, of flat ones of their frame
    Rectangle frame;   // flat ones
    bool flat = false, fills = false;
  };
  struct Cell {
    std::uint32_t surface = 0;
    UnitRect rect;
    bool flat = false;
  };

  /// Returns the area that cells are cut from.
  double addSurface(const Shape& rest, PrimitiveId, std::uint32_t triangle, std::uint32_t object, double limit,
                    std::vector<std::pair<Code, Cell>>&);
  void place(Surface&, const Shape&) const;
  bool onSurface(const Surface&, const Vec3&) const;
  void boundNodes();
  /// By node: whether some of its cells are where they were read, and whether some are not.
  struct Edited {
    std::vector<char> none, some;
  };
  Edited edited() const;
  BoundingSphere boundOf(const Cell&, const Shape&) const;

  const Scene& scene_;
  std::vector<Surface> surfaces_;
  std::vector<Cell> cells_;
  std::vector<RadixNode> nodes_;
  std::vector<BoundingSphere> bounds_, restBounds_;  // by node
  std::vector<char> holdsAll_;                       // by node
  std::vector<std::uint32_t> leaf_;                  // by cell: its node
  std::vector<double> cumulative_;                   // of weights, one more
  std::vector<std::uint32_t> surfaceOf_;             // by primitive: first surface, or none
};

/// Greatest share of incident light that a surface passes on other than diffusely.
float specularAlbedo(const Material&);

}  // namespace deltalux::particles
