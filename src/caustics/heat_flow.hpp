#pragma once
// Smoothing by the flow of heat over the cells of a surface: dE/dt = div(D grad E), without flow through outlines. As a
// density estimate this is the kernel method at its best on bounded, curved domains [Botev10]: the kernel is Gaussian,
// of variance 2 D t, where D is constant; it keeps the flux to the last bit of rounding, reproduces a uniform density
// exactly whatever D is, and so neither darkens at borders nor shows seams. Where D varies the kernel does, and a small
// D is a wall to what lies on either side of it.
//
// exp(-t L) is summed as a Chebyshev series: as many steps as the widest kernel's radius in cells times 7, each a pass
// over all borders; several times at once share the steps. Rejected: implicit steps (their kernel is a spike with long
// tails), Runge-Kutta-Chebyshev (it hardly damps what it keeps stable, and noise is what we are here to damp).
#include <cstdint>
#include <deltalux/units.hpp>
#include <span>
#include <vector>

#include "caustics/cell_graph.hpp"

namespace deltalux {

/// A factor in [0, 1] for each border, by its index (both ways the same); empty: all are open.
using Openness = std::span<const float>;

/// Values of cells, one array for each channel.
using Channels = std::vector<std::vector<float>>;

class HeatFlow {
 public:
  /// `conductivity`: D of every cell [unit^2 per unit of time]; across a border its harmonic mean holds, times the
  /// border's openness. The graph must outlive this.
  HeatFlow(const CellGraph&, std::span<const float> conductivity, Openness open = {});

  /// E after `time`, but for a share of `negligible`. E is a density over the cells' areas.
  void apply(std::vector<float>& E, double time, double negligible = 1e-6) const;
  void apply(Channels& E, double time, double negligible = 1e-6) const;
  /// The same for several times, ascending.
  std::vector<Channels> after(Channels E, std::span<const double> times, double negligible = 1e-6) const;
  /// One short explicit step: it rounds off the steps of values that were spread from coarser cells. Where cells are
  /// too small for it, it goes as far as is stable, and does not keep their flux.
  void relax(Channels& E, double time) const;

 private:
  static constexpr std::size_t kChunk = 128;   // cells whose sums stay close by
  static constexpr std::size_t kWorth = 8192;  // cells, from which on rows are shared by threads

  void addChunk(const CellGraph::Run&, std::uint32_t begin, std::uint32_t count, const float* light,
                float* __restrict sums) const;
  template <class Out>
  void step(const Channels& from, const Out& out) const;
  template <class Out>
  void stepRow(std::uint32_t first, std::uint32_t end, const Channels& from, const Out& out) const;

  std::span<const CellGraph::Run> runs_;
  std::vector<std::uint32_t> rows_;  // index of the first run of every row of cells, and of the end
  std::vector<float> weights_;       // by border, relative to the largest eigenvalue
  std::vector<float> own_;           // what a cell keeps
  double largest_ = 0;               // bound of L's eigenvalues
};

}  // namespace deltalux
