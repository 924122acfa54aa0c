#pragma once
// One passive value: all state of a solution.
#include <deltalux/solution.hpp>

#include "caustics/caustics.hpp"
#include "hierarchy/element.hpp"
#include "hierarchy/link.hpp"
#include "lines/lines.hpp"
#include "particles/particles.hpp"
#include "solution/light_columns.hpp"
#include "solution/solve_memory.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct Solution {
  Scene scene;  // what was solved: without speculars when settings.diffuseOnly
  SolveSettings settings;
  std::shared_ptr<const tracing::RayTracer> tracer;  // over `scene`
  hierarchy::Elements elements;
  hierarchy::Links links;               // that light is exchanged over, by the paper's method
  particles::Particles particles;       // a function of scene, seed and target count
  lines::Lines lines;                   // of the receiving leaves, where light is exchanged by lines
  std::vector<float> deviation;         // of them in order: standard error of a leaf's irradiance, gray [W/m2]
  std::shared_ptr<SolveMemory> memory;  // of the last solve over lines, had it all the time it wanted; not in files
  std::vector<Rgb> sampledScale;        // by light: its scale when links last followed it
  caustics::Caustics caustics;          // how the particles' light is shown; never feeds back
  LightColumns columns;                 // the same light by groups of lights, where the settings ask for it
  SolveReport report;
};

/// The same for solutions that are the same, whatever the order in which their patches came about.
struct SolutionHashes {
  std::uint64_t mesh = 0, lines = 0, particles = 0;
};
SolutionHashes hashesOf(const Solution&);

}  // namespace deltalux
