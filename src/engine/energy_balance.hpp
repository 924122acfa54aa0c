#pragma once
// Where the light of a solution goes, every sum made on its own: what is not accounted for is the solution's error, not
// hidden in a difference.
//
//   emitted   what lights bring to surfaces, straight or, where those only pass it on (mirrors, glass), as particles
//   absorbed  by diffuse surfaces of all that arrives, less what particles take on from there; by mirrors, glass,
//             panes, and by sides so hidden that they have no element: what rays from leaves into such gaps find there,
//             and particles that land there
//   escaped   of what diffuse surfaces send: by rays from them in all directions; of what particles carry: theirs
//
// Light that panes keep from lights' own light is not emitted: it reaches no surface.
// Cost: 262,000 rays (standard error below 0.03 % of what is emitted), 20 nanoseconds a path.
#include <deltalux/report.hpp>

#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

/// The first of the sums alone: without a ray [W].
double emittedPower(const Solution&, const particles::ParticleTransfer&);
/// Of a converged solution; `residual`: what its last iteration still changed [W].
EnergyLedger energyBalance(const Solution&, const particles::ParticleTransfer&, const RgbSum& residual);

}  // namespace deltalux::engine
