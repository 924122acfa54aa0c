#pragma once
// A solution as its users see it: counts, times, the energy ledger, and a read-only handle for probe, render and save.
#include <cstdint>
#include <deltalux/scene.hpp>
#include <deltalux/settings.hpp>
#include <memory>

namespace deltalux {

/// Where the light went [W, with the square of the scene's unit as area], per channel.
struct EnergyLedger {
  RgbSum emitted{0.0};    // what lights deliver to surfaces (sun and sky: what falls on surfaces)
  RgbSum absorbed{0.0};   // (1 - rho - tau) E A over all surfaces
  RgbSum escaped{0.0};    // reflected, but on to no surface
  RgbSum unsettled{0.0};  // still on its way at the last iteration
};

/// Seconds by phase.
struct PhaseTimes {
  double import = 0, hierarchy = 0, refine = 0, visibility = 0, gather = 0, particles = 0, textures = 0, total = 0;
};

/// Work done and memory held.
struct SolveCounts {
  std::uint64_t elements = 0, leafElements = 0, links = 0, activeLinks = 0, linksDs = 0, particles = 0, impacts = 0;
  std::uint64_t raysVisibility = 0, raysParticles = 0, iterations = 0, textures = 0;
  std::uint64_t provenClear = 0, provenBlocked = 0;
  std::uint64_t bytesElements = 0, bytesLinks = 0, bytesParticles = 0, bytesOctree = 0, bytesTextures = 0;
};

struct SolveReport {
  PhaseTimes time;
  SolveCounts counts;
  EnergyLedger energy;
  bool converged = false;  // the error target is met everywhere and the light has settled
};

struct Solution;  // all state; src/solution/solution.hpp

/// A shared, read-only handle on a solution. It shows the engine's present state: read it between steps.
class SolutionView {
 public:
  explicit SolutionView(std::shared_ptr<const Solution> solution) : solution_(std::move(solution)) {}

  const Solution& get() const { return *solution_; }
  const Scene& scene() const;
  const SolveSettings& settings() const;
  const SolveReport& report() const;

 private:
  std::shared_ptr<const Solution> solution_;
};

}  // namespace deltalux
