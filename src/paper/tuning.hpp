#pragma once
// The tuned constants of links between elements: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::paper::tuning {

/// What links may err by, for an error of irradiance (docs/links.md): errors of links add up to less, as they differ in
/// sign. Smaller ones cost memory first: half the error, two thirds more links.
constexpr double kLinkError = 4;
/// What a link to or from a cluster leaves unknown in any case, relative to K: order-2 harmonics for clamped cosines,
/// one visibility for surfaces of unlike brightness; and the least share of its mean that a cluster sends anywhere,
/// since harmonics blur what faces away. Less: indirect light in blocks. More: links to all that is in them.
constexpr float kClusterSpread = 0.3f;

}  // namespace deltalux::paper::tuning
