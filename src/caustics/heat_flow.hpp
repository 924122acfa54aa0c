#pragma once
// Smoothing by the flow of heat over the cells of a surface: dE/dt = div(D grad E), without flow through outlines. As a
// density estimate this is the kernel method at its best on bounded, curved domains [Botev10]: the kernel's variance is
// 2 D t where D is constant; it keeps the flux to the last bit of rounding, reproduces a uniform density exactly
// whatever D is, and so neither darkens at borders nor shows seams. Where D varies the kernel does, and a small D is a
// wall to what lies on either side of it.
//
// Instead of exp(-t L) a polynomial of L is taken that is 1 - t L + ... as it is, and small where exp is: Gegenbauer's,
// by their recurrence, as explicit solvers of the heat equation take them [OSullivan19]. With the order kOrder the
// kernel is (1 - r^2 / R^2)^2, R^2 = 8 the variance: it ends where a Gaussian fades, its noise is 10 % less than that
// of a Gaussian as wide, and one recurrence of 2.8 steps a cell of the standard deviation makes it, without sums beside
// it. Rejected: exp(-t L) as a Chebyshev series (twice the steps, and sums), implicit steps (their kernel is a spike
// with long tails), steps by Chebyshev's or Legendre's polynomials (they hardly damp what they keep stable, and noise
// is what we are here to damp). Cost: 0.4 nanoseconds a cell, channel and step.
#include "caustics/cell_raster.hpp"

namespace deltalux::caustics {

class HeatFlow {
 public:
  /// `conductivity`: D of every slot [unit^2 per unit of time], the same for the texels of a cell, or nothing: 1.
  /// Across a border its harmonic mean holds, times the border's edge-stopping factor in [0, 1]; nullptr: all are open.
  /// The raster must outlive this.
  HeatFlow(const CellRaster&, std::span<const float> conductivity, const Borders* open = nullptr);

  /// E after `time`, in place. E is a density over the cells' areas, the same for the texels of a cell.
  void apply(Slots& E, double time) const;
  /// Of one to three channels.
  void apply(Channels& E, double time) const;

 private:
  static constexpr double kOrder = 3.5;         // [defined]
  static constexpr std::size_t kWorth = 16384;  // slots, from which on rows are shared by threads [task]

  struct Factors {
    float flow, now, before;  // of what flows, of the polynomial of before, and the one before it
  };
  template <std::size_t channels>
  void stepRow(std::size_t row, const Factors&, const std::array<float*, channels>& now,
               const std::array<float*, channels>& before) const;
  template <std::size_t channels>
  void applyTo(Channels& E, double time) const;

  const CellRaster& raster_;
  Borders through_;     // conductance of the borders
  Slots own_;           // that of all borders of a slot
  Slots perArea_;       // 1 / area, or 0
  double largest_ = 0;  // bound of L's eigenvalues
};

}  // namespace deltalux::caustics
