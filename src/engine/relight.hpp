#pragma once
// Light of the leaves over the lines there are: what lamps and skies bring, as they are dimmed, and particles, handed
// on until it no longer changes. No ray is traced.
#include "solution/solution.hpp"

namespace deltalux::engine {

/// By leaf, in order: what single lamps bring to it.
using LampsOfLeaves = std::vector<std::span<const direct::LampLight>>;
LampsOfLeaves lampsOf(const PatchSamples&, std::span<const DimLeaf>, const hierarchy::LeafTable&);

/// What lights send of what samples took them for.
struct Dimming {
  std::vector<Rgb> lights;  // by light
  Rgb skies{1.0f};          // all of them

  /// As samples took them.
  static Dimming none(const Scene&);
  static Dimming of(const Scene&, const direct::Skies&);
};

/// Writes the elements' irradiance and radiosity, from the particles' light and the indirect light that they have, and
/// the solution's deviations. To be pulled up then. The lights' own emission is left as it is.
void relight(Solution&, const hierarchy::LeafTable&, lines::Exchange&, const LampsOfLeaves&, const KnownSky&,
             const Dimming&, double converged);

}  // namespace deltalux::engine
