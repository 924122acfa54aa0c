#pragma once
// What sends particles: lights, and the sides of diffuse surfaces, in cells, in a forest of radix trees: one tree for
// each light and one for all surfaces. A sender's cells depend on its shape as it was read, not on where edits have put
// it nor on what it emits.
#include <span>

#include "particles/radix_tree.hpp"
#include "particles/receivers.hpp"
#include "particles/surface_cells.hpp"
#include "scene/light_sampling.hpp"

namespace deltalux::particles {

enum class SenderKind : std::uint8_t {
  Side,   // one side of a surface with a diffuse part: sends its radiosity
  Lamp,   // one side of an emitting surface
  Point,  // any point-like light
  Sun,
  Sky,  // a part of a dome's directions
};

struct SenderCell {
  SenderKind kind = SenderKind::Side;
  bool front = true;         // Side, Lamp
  std::uint16_t unused = 0;  // so that no byte of a stored record is left to chance
  LightId light;             // all but Side
  PrimitiveId primitive;     // Side, Lamp
  float measure = 0;         // Side, Lamp: area, 0 when it was removed; Sun, Sky: solid angle
  UnitRect rect;             // Side, Lamp: of the numbers that sample the shape; Sky: of azimuth and height
};

class Senders {
 public:
  /// Both must outlive this.
  Senders(const Scene&, const scene::LightSampler&);
  /// Takes in where these primitives are now. Returns by cell whether it moved.
  std::vector<char> follow(std::span<const PrimitiveId>);

  const std::vector<SenderCell>& cells() const { return cells_; }
  const std::vector<RadixNode>& nodes() const { return nodes_; }
  /// One node for each light that shines (scale left out); one for the surfaces, if there are any.
  std::span<const std::uint32_t> lightRoots() const { return {roots_.data(), lightTrees_}; }
  std::span<const std::uint32_t> surfaceRoots() const { return std::span(roots_).subspan(lightTrees_); }
  /// Senders at a place: a sphere that holds the node. At infinity: the mean direction, and the angle around it.
  const BoundingSphere& bound(std::uint32_t node) const { return bounds_[node]; }
  /// Normals of a node lie within the half angle of this cosine about the axis; -1: anywhere.
  struct Cone {
    Vec3 axis{0, 0, 1};
    double cosine = -1;
  };
  const Cone& normals(std::uint32_t node) const { return normals_[node]; }
  /// What cells send, as far as it is known before any solution, gray: exitance of surfaces, radiance of sky cells.
  /// Cells are drawn by it times their measure at rest.
  void weigh(std::span<const float> strength);
  /// A cell below the node, drawn by weight, and its chance; `u` in [0,1).
  struct Choice {
    std::uint32_t cell = 0;
    double chance = 1;
  };
  Choice choose(std::uint32_t node, double u) const;
  /// The same, but the nearer to `towards` (at rest), the sooner, and seldom what turns its back on it: of senders at a
  /// place.
  Choice chooseNear(std::uint32_t node, const BoundingSphere& towards, double u) const;
  double weight(std::uint32_t cell) const { return cumulative_[cell + 1] - cumulative_[cell]; }
  double weightOf(const RadixNode& node) const { return cumulative_[node.end] - cumulative_[node.begin]; }
  /// The cells of surfaces are [surfaceCells(), cells().size()).
  std::uint32_t surfaceCells() const { return surfaceCells_; }

  /// The Side cell that holds a point given by its parameters (of the triangle, for meshes); kNone when that side is
  /// not diffuse.
  std::uint32_t cellOf(PrimitiveId, std::uint32_t triangle, bool front, const Vec2& uv) const;

  /// A point of a Side or Lamp cell, uniform by area, with the unit normal of the cell's side.
  SurfacePoint point(std::uint32_t cell, const Vec2& u) const;
  /// A direction towards a Sun or Sky cell, uniform in solid angle.
  Vec3 direction(std::uint32_t cell, const Vec2& u) const;

  std::size_t memoryBytes() const;

 private:
  void addLight(LightId, double limit);
  void addSurfaces(double limit);
  void addTree(std::vector<std::pair<Code, SenderCell>>, std::uint64_t seed);
  void place(std::uint32_t cell);
  void boundNodes();
  void boundLeaf(std::uint32_t cell, const Shape*);

  /// What drawing by nearness asks, of things at rest, in one place.
  struct NearNode {
    Vec3 center{0};
    double squaredRadius = 0;
    Vec3 normal{0};              // of flat sides
    double offset = -kInfinity;  // of the plane that they shine from; none: anywhere
    double weight = 0;
    std::uint32_t child[2] = {RadixNode::kNone, RadixNode::kNone};

    bool averted(const BoundingSphere& from) const { return glm::dot(normal, from.center) + from.radius <= offset; }
  };
  void rememberRest();
  /// Of a light at infinity: its axis, and one minus the cosine of the angle around it.
  struct Beam {
    Frame frame{Vec3(0, 0, 1)};
    double depth = 0;
  };
  Beam beamOf(LightId) const;

  const Scene& scene_;
  const scene::LightSampler& lights_;
  std::vector<SenderCell> cells_;
  std::vector<float> restMeasure_;   // by cell
  std::vector<std::uint32_t> leaf_;  // by cell: its node
  std::vector<RadixNode> nodes_;
  std::vector<BoundingSphere> bounds_;
  std::vector<NearNode> near_;
  std::vector<Cone> normals_;
  std::vector<Beam> beams_;  // by light
  std::vector<double> cumulative_;
  std::vector<std::uint32_t> roots_;
  std::size_t lightTrees_ = 0;
  std::uint32_t surfaceCells_ = 0;
  std::vector<std::uint32_t> firstCell_;  // by primitive and side; kNone
  std::vector<std::uint8_t> halvings_;    // by primitive
};

}  // namespace deltalux::particles
