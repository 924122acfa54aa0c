#pragma once
#include "particles/particles.hpp"

namespace deltalux::particles {

/// Gives links their numbers of samples: in proportion to their flux, so that all particles carry about the same; where
/// that is less than one, one by chance, that counts for more. About `target` will arrive at a receiver. More for a
/// larger target, never fewer: the samples of the smaller one are among them. [algorithm 4, quantum]
void countPaths(const DsLinks&, double target, Particles&);

/// About how many of the samples arrive, of those that start.
double arrivingShare(const DsLinks&);

}  // namespace deltalux::particles
