#pragma once
// Which connection to try where: a grid over the scene, each cell with chances for surfaces of six orientations, in
// proportion to the light that every connection brought there, shadows and cosine included, in a few test samples,
// smoothed over neighbours. No chance is ever zero, so the choice changes the noise and not the result. Keyed by cell:
// the same table for any thread count. Cost: cells x connections x a handful of rays, within the budget given.
#include <vector>

#include "render/reference/light_connections.hpp"

namespace deltalux::rendering {

class ConnectionTable {
 public:
  /// `budget`: test samples over all cells and connections, about.
  ConnectionTable(const ReferenceScene&, const LightConnections&, double budget);

  struct Choice {
    int connection = -1;  // -1: there is no light at all
    double chance = 0;
  };
  Choice choose(const Vec3& position, const Vec3& normal, double u) const;
  double chance(const Vec3& position, const Vec3& normal, int connection) const;

 private:
  /// Light that a connection brings to surfaces facing +x, -x, +y, -y, +z, -z.
  using Facings = std::array<float, 6>;

  std::size_t cellOf(const Vec3& position) const;
  std::size_t rowOf(const Vec3& position, const Vec3& normal) const;
  std::vector<Facings> learn(const ReferenceScene&, const LightConnections&, std::size_t cell) const;
  void smooth(const std::vector<std::vector<Facings>>& learned);

  glm::ivec3 resolution_{1};
  Vec3 origin_{0}, cellSize_{1};
  std::size_t connections_ = 0;
  std::vector<float> cumulative_;  // [cell][facing][connection], ends at 1
};

}  // namespace deltalux::rendering
