#pragma once
// Sides of surfaces cut into tiles that hold some particles each: fine enough to see where light has changed, coarse
// enough that one particle among many is no change. Tiles are equal squares of the parameters; on meshes, runs of
// triangles.
#include <deltalux/scene.hpp>

#include "particles/particles.hpp"

namespace deltalux::caustics {

class SurfaceTiles {
 public:
  /// As many as today's particles ask for.
  SurfaceTiles(const Scene&, const particles::Particles&);

  /// Of an impact: its slot. A side that no particle met before gets one tile now.
  std::uint32_t tileOf(const particles::Particles&, std::uint32_t impact);

  /// One side's tiles: from `first` on; none when no particle ever met it.
  struct Side {
    std::uint32_t first = 0, across = 0;  // a power of two, or none
    float area = 0;                       // of one tile [unit^2]

    std::uint32_t count() const { return across * across; }
  };
  const std::vector<Side>& sides() const { return sides_; }  // by 2 * primitive + (front ? 0 : 1)
  std::size_t size() const { return tiles_; }

 private:
  void cut(std::size_t side, std::uint32_t across);

  const Scene& scene_;
  std::vector<Side> sides_;
  std::uint32_t tiles_ = 0;
};

}  // namespace deltalux::caustics
