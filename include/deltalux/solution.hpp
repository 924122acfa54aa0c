#pragma once
// A solution as its users see it: what solving did, and a read-only handle for probe, render and save.
#include <cstdint>
#include <deltalux/report.hpp>
#include <deltalux/scene.hpp>
#include <deltalux/settings.hpp>
#include <memory>

namespace deltalux {

/// What solving did, summed over the rounds so far.
struct SolveReport {
  PhaseTimes times;
  WorkCounts counts;
  MemoryBytes memory;
  ErrorEstimate error;
  EnergyLedger energy;
  std::uint64_t cutParticles = 0;  // by the limit of 64 events
  bool converged = false;          // the error target is met everywhere and the light has converged
};

struct Solution;  // all state; src/solution/solution.hpp

/// A shared, read-only handle on a solution. It shows the engine's present state: read it between steps.
class SolutionView {
 public:
  explicit SolutionView(std::shared_ptr<const Solution> solution) : solution_(std::move(solution)) {}

  const Solution& get() const { return *solution_; }
  const std::shared_ptr<const Solution>& share() const { return solution_; }
  const Scene& scene() const;
  const SolveSettings& settings() const;
  const SolveReport& report() const;
  /// The caustic textures, side by side of the surfaces that have them.
  std::vector<CausticReport> caustics() const;

 private:
  std::shared_ptr<const Solution> solution_;
};

}  // namespace deltalux
