#pragma once
// How far a patch sees, by its first lines: what decides how fine the mesh must be for indirect light, whose gradient
// is bounded by the harmonic mean distance [WH92].
#include "lines/first_lines.hpp"

namespace deltalux::lines {

struct LeafScale {
  float harmonic = std::numeric_limits<float>::infinity();  // mean distance [scene units]
  float mean = 0;                                           // arithmetic; lines out of the scene: SceneWidths::farthest
  std::uint64_t covered = 0;  // bit i: point i of the leaf's sequence lies under something
  std::uint32_t known = 0;    // how many points that is known of, at most 64
  std::uint32_t rays = 0;
};

class ScaleMeter {
 public:
  /// All must outlive this. `enclosed`: by element of the input level.
  ScaleMeter(const hierarchy::Elements&, const LineTracer&, const Cover&, const std::vector<char>& enclosed);

  /// `first` becomes the lines that were traced for it.
  LeafScale measure(hierarchy::ElementId patch, FirstLines& first) const;

 private:
  const hierarchy::Elements& elements_;
  const LineTracer& tracer_;
  const Cover& cover_;
  const std::vector<char>& enclosed_;
  float farthest_;
};

/// Sets the mean free path of receiving input-level patches, which their parts inherit: by their lines, but no less
/// than a share of what is usual about them.
void setMeanFreePaths(hierarchy::Elements&, const std::vector<LeafScale>&);

/// Whether a patch is too wide for indirect light at such an error. `dim`: its light relative to what still matters;
/// where that is less than 1 it may be wider. `room`: SceneWidths::room.
bool tooWide(const hierarchy::ElementGeometry&, const LeafScale&, double error, double dim, double room);

}  // namespace deltalux::lines
