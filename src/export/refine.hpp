#pragma once
// Direct light of a side at its triangles' corners as shadow rays measure it there, and more corners where it is not
// linear between them: along the edges of shadows, until all that is left is finer than a smallest size.
//
// An edge is looked at in its middle; where direct light is off by more than is allowed, it is cut where most of the
// step lies, or where it is bent most. The cuts of a triangle's edges are joined across it, so that a straight shadow
// has few corners, as in discontinuity meshing, without a search for its wedges. Triangles that share an edge cut it at
// one place. Light other than measured stays linear. Corners on borders are measured a little inside:
// what stands there ends in them.
// Cost: about six measurements a vertex, and some fifteen for each that is added.
#include <deltalux/solution_mesh.hpp>
#include <span>
#include <vector>

#include "export/direct_light.hpp"

namespace deltalux::exporting {

constexpr double kShareOfError = 0.5;  // of the solution's, that an export may add to it [limit]

/// One side's triangles and light.
struct LitSide {
  std::vector<MeshVertex> vertices;  // their light is not read
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::vector<Rgb>> all, direct;  // irradiance by group and vertex: all of it, and what of it is direct
};

struct Refinement {
  double error = 0.01;  // of a group's light at a place, or of `share` of all light there if that is more
  double share = 0.03;
  std::vector<double> floors;  // by group: light below it is not told more finely [W/m2, gray]; empty: 0
  double smallest = 0;         // edges shorter than twice that are not cut [scene units]
  double border = 0;           // how far inside corners on borders are measured [scene units]
  bool keepsShape = false;     // no corners are added: caustic textures lie on the same triangles

  /// In the units of a scene.
  static Refinement of(const Scene&, double error);
};

/// By group, the share of its mean over sides below which light does not matter [W/m2, gray].
class LightFloors {
 public:
  explicit LightFloors(std::size_t groups) : light_(groups, 0.0) {}
  void add(const LitSide&);
  void add(const std::array<const MeshVertex*, 3>& corners, const std::array<std::uint32_t, 3>& numbers,
           const std::vector<std::vector<Rgb>>& layers);
  std::vector<double> floors() const;

 private:
  std::vector<double> light_;  // by group: area times irradiance
  double area_ = 0;
};

/// Caustic textures lie on the triangles of one that keeps its shape.
struct SideToRefine {
  LitSide* side;
  const Shape* shape;
  bool front = true, keepsShape = false;
};
/// All sides of a scene: corners are added where they are worth most, some ten thousands in all.
void refine(std::span<const SideToRefine>, const DirectLight&, const Refinement&);
/// Puts what is measured in the place of `direct`, in `all` too.
void refine(LitSide&, const Shape&, bool front, const DirectLight&, const Refinement&);

}  // namespace deltalux::exporting
