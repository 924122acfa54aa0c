#pragma once
// Light of the leaves by iteration to convergence over their exchange (Jacobi), from the light that sources bring them.
#include "lines/exchange.hpp"

namespace deltalux::lines {

/// By leaf.
struct LeafLight {
  std::vector<Rgb> rho, tau;  // of its side: diffuse reflectance, and transmittance to the other
  std::vector<Rgb> source;    // irradiance that is not exchanged: direct light, particles [W/m2]
  std::vector<Rgb> indirect;  // irradiance over lines [W/m2]; what is there is taken for a start
  std::vector<Rgb> B;         // radiosity [W/m2]
  /// Leaves with transmittance, and the leaves behind them with their shares of its place, which sum to one.
  struct Behind {
    std::uint32_t leaf, other;
    float share;
  };
  std::vector<Behind> behind;
};

/// As `leaves` says of reflectances; no light yet.
LeafLight leafLight(const hierarchy::Elements&, const hierarchy::LeafTable&);

/// More than any scene needs: halls of white plaster take some fifty.
inline constexpr int kMostPasses = 2048;  // [limit]

struct IterationReport {
  int passes = 0;
  RgbSum emitted{0.0};   // by diffuse surfaces of their sources' light [W, unit^2 as area]
  RgbSum residual{0.0};  // power that the last pass changed
  double change = 0;     // most of a leaf's radiosity that it changed, relative
};

/// Passes until what is yet to come is below `converged` times the emitted, as far as they tell, and no leaf, however
/// dim, has changed by more than a tenth of the usual error, or `most` are done.
IterationReport iterate(Exchange&, LeafLight&, double converged, int most);

}  // namespace deltalux::lines
