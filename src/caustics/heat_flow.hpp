#pragma once
// Smoothing by the flow of heat over the cells of a surface: dE/dt = div(D grad E), without flow through outlines. As a
// density estimate this is the kernel method at its best on bounded, curved domains [Botev10]: the kernel is Gaussian,
// of variance 2 D t, where D is constant; it keeps the flux to the last bit of rounding, reproduces a uniform density
// exactly whatever D is, and so neither darkens at borders nor shows seams. Where D varies the kernel does, and a small
// D is a wall to what lies on either side of it.
//
// exp(-t L) is summed as a Chebyshev series: as many steps as the widest kernel's radius in cells times 7, each a pass
// over all borders. Cells that have their neighbours at the same distances, as those of a row inside a surface, form
// runs, over which a pass is arithmetic on arrays. Rejected: implicit steps (their kernel is a spike with long tails),
// Runge-Kutta-Chebyshev (it hardly damps what it keeps stable, and noise is what we are here to damp).
#include <cstdint>
#include <deltalux/units.hpp>
#include <span>
#include <vector>

#include "caustics/cell_grid.hpp"

namespace deltalux {

/// A factor in [0, 1] for each border, in the grid's order (both ways the same); empty: all are open.
using Openness = std::span<const float>;

class HeatFlow {
 public:
  /// `conductivity`: D of every cell [unit^2 per unit of time]; across a border its harmonic mean holds, times the
  /// border's openness.
  HeatFlow(const CellGrid&, std::span<const float> conductivity, Openness open = {});

  /// E after `time`, but for a share of `negligible`. E is a density over the cells' areas.
  void apply(std::vector<float>& E, double time, double negligible = 1e-6) const;
  void apply(std::vector<glm::vec2>& E, double time, double negligible = 1e-6) const;
  void apply(std::vector<Rgb>& E, double time, double negligible = 1e-6) const;

 private:
  static constexpr std::size_t kChunk = 128;  // cells whose sums stay close by
  static constexpr std::size_t kMostNeighbours = 8;
  /// Cells in a row whose neighbours are at the same distances in the grid's order. A cell with more neighbours than
  /// kMostNeighbours has several runs of its own.
  struct Run {
    std::uint32_t first = 0, count = 0;
    std::uint32_t weights = 0;  // first of `count` for each neighbour, one neighbour after the other
    std::uint32_t neighbours = 0;
    std::int32_t offset[kMostNeighbours] = {};
  };

  void addRuns(const CellGrid&, const std::vector<float>& edgeWeights);
  void addChunk(const Run&, std::uint32_t begin, std::uint32_t count, const float* light, float* __restrict sums) const;
  using Channels = std::vector<std::vector<float>>;
  template <class Out>
  void step(const Channels& from, const Out& out) const;
  void run(Channels& E, double time, double negligible) const;
  template <class Value>
  void applyTo(std::vector<Value>& E, double time, double negligible) const;

  std::vector<Run> runs_;
  std::vector<float> weights_;  // relative to the largest eigenvalue
  std::vector<float> own_;      // what a cell keeps
  double largest_ = 0;          // bound of L's eigenvalues
};

}  // namespace deltalux
