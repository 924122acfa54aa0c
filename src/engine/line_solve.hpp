#pragma once
// A solve over stored lines: a pipeline of values, each of which is a function of the scene alone. [lines.md]
//
//   particles of lights -> sides and hollows -> coarse light -> mesh -> lines -> exchange -> light
//
// The coarse light is that of the input level, a solution of its own that is there soon; by it the mesh knows how much
// light there is about where direct light varies. Stages: line_mesh.cpp, line_light.cpp, dim_leaves.cpp; their order:
// line_solve.cpp.
#include <deltalux/progress.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "direct/dim_direct.hpp"
#include "direct/sky_light.hpp"
#include "engine/known_solve.hpp"
#include "engine/relight.hpp"
#include "engine/time_budget.hpp"
#include "lines/leaf_scale.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

/// What the stages share: the scene as each layer sees it, and what they have found so far.
struct LineSolve {
  /// The solution must outlive this, and what is known of one before.
  explicit LineSolve(Solution&, KnownSolve* known = nullptr);

  Solution& s;
  KnownSolve* known;
  lines::SurfaceResponses responses;
  lines::LineTracer tracer;
  lines::Cover cover;
  std::vector<Rgb> nominal;  // by light: the scale that all is decided by
  direct::Lamps lamps;       // at those
  direct::Skies skies;
  std::vector<lines::LightWalks> walks;  // by element of the input level
  std::vector<char> enclosed;            // the same: whether neither they nor particles find light
  PatchSamples samples;
  particles::Details details;  // by element, of particles on it
  std::vector<char> measured;  // by element: that its samples are of this solve, or have been found to hold
  std::vector<DimLeaf> dim;    // direct light where light hardly comes
  lines::ListsOfLeaves<lines::EscapedLine> escaped;  // of the lines, in the end
  lines::ListsOfLeaves<lines::Bend> bends;           // of the same
  KnownSky sky;                                      // of this stage; before it, what is known of it
  CoarseLines coarse;                                // of the coarse light
  std::optional<lines::KnownLines> knownLines;       // what is known of the lines before, of those of this stage
  std::unique_ptr<lines::Exchange> exchange;         // over the lines, in the end; before it, what was known of that
  double floor = 0;                                  // light that still matters [W/m2, gray]
  std::optional<particles::ParticleTransfer> transfer, coarseTransfer;  // on the mesh, in the end; on the input level
  bool allParticles = true;                                             // as many as the error asks for: there was time

  bool takesPart(hierarchy::ElementId patch) const;
  /// Samples of all elements there are.
  void resizeSamples() { samples.resize(s.elements.size()), measured.resize(s.elements.size(), false); }
};

// The mesh.

/// What is known of lamps at the patch that this one is a part of.
direct::LampSight sightAbove(const PatchSamples&, const hierarchy::Elements&, hierarchy::ElementId patch);
/// Samples of the input level, and its direct light for the coarse solution, which is kept apart.
void sampleInputs(LineSolve&, std::span<const hierarchy::ElementId> inputs);
/// Samples that decide about patches, and their direct light.
void samplePatches(LineSolve&, std::span<const hierarchy::ElementId> patches);
/// Splits patches, from these down, until indirect and direct light vary over none by more than the error allows, or
/// `stop` says that time is up. Returns whether it came to the end.
bool refineMesh(LineSolve&, std::vector<hierarchy::ElementId> patches, const std::function<bool()>& stop);

// The light.

/// More lines, and shadow rays, of leaves in rooms where hardly any light arrives: leaves have `counts` lines at least,
/// which become those that they should have. dim_leaves.cpp.
void lookIntoTheDark(LineSolve&, const lines::LineScene&, std::vector<std::uint32_t>& counts, lines::TracedLines&);
/// About `base` lines of each of the leaves there are; those that are known are taken. Throws Interrupted.
using TakeLines = std::optional<lines::KnownLines> (KnownSolve::*)(const hierarchy::Elements&, lines::TracedLines&);
lines::TracedLines traceLeaves(LineSolve&, std::uint32_t base, TakeLines, Progress*);
/// Light of the leaves over those, from their direct light and particles: writes the elements' irradiance and
/// radiosity, the solution's lines and their deviation. Throws Interrupted.
void lightLeaves(LineSolve&, lines::TracedLines, const Dimming&, double converged, Progress*);
/// Light that still matters, where there is as much as on these [W/m2, gray].
double floorOf(const hierarchy::Elements&);
/// What the solution's own samples say of its error, by area.
ErrorEstimate estimateError(const Solution&);

// The rounds.

/// Leaves whose lines are others than before, or new.
std::size_t changedLeaves(const LineSolve&);
/// What the next solve may ask of one that is done.
std::shared_ptr<SolveMemory> memoryOf(LineSolve&&);

/// The coarse solution; what is known of one before may be none. Throws Interrupted.
std::unique_ptr<LineSolve> solveCoarsely(Solution&, KnownSolve*, const TimeBudget&, Progress*);
/// From that to the error that was asked for, as far as the time goes. Returns whether that was all of it. Throws
/// Interrupted.
bool solveFinely(LineSolve&, const TimeBudget&, Progress*);

}  // namespace deltalux::engine
