#pragma once
// Keeps a solution's light apart by groups of lights (solution/light_columns.hpp): each column is iterated over the
// lines that all of them share, from the light of its own lamps alone. No ray is traced.
// Cost: an iteration from nothing, and its own caustic textures, a group.
#include <deltalux/progress.hpp>

#include "engine/relight.hpp"
#include "particles/transfer.hpp"

namespace deltalux::engine {

/// What light is handed on by.
struct LightParts {
  const hierarchy::LeafTable& leaves;
  lines::Exchange& exchange;
  const LampsOfLeaves& lamps;
  const KnownSky& sky;
  const direct::Skies& skies;
  const std::vector<Rgb>& nominal;  // by light
  const particles::ParticleTransfer& transfer;
};

/// The columns of the groups that the settings ask for; the solution's light becomes their sum. Throws Interrupted.
void keepLightsApart(Solution&, const LightParts&, Progress*);

}  // namespace deltalux::engine
