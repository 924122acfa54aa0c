#pragma once
// The tuned constants of links between elements: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::paper::tuning {

/// What links may err by, for an error of irradiance (docs/links.md): errors of links add up to less, as they differ in
/// sign. Smaller ones cost memory first: half the error, two thirds more links.
constexpr double kLinkError = 4;
/// Error of links from round to round, relative. Smaller: refined by light that is not yet known. Larger: more rounds.
constexpr double kRounds = 0.35;
/// Error of the mean over a sender's nodes, relative to their spread: a uniform sender is integrated, not sampled, and
/// splitting it would only hide the receiver's error. More: links in the square.
constexpr double kQuadrature = 0.1;
/// What a link to or from a cluster leaves unknown in any case, relative to K: order-2 harmonics for clamped cosines,
/// one visibility for surfaces of unlike brightness; and the least share of its mean that a cluster sends anywhere,
/// since harmonics blur what faces away. Less: indirect light in blocks. More: links to all that is in them.
constexpr float kClusterSpread = 0.3f;
/// Rays of links that bring little, or are split for their kernel; others take twice or four times as many. A list of
/// no more blockers is looked through before any ray. Fewer: blotchy shadows.
constexpr int kFewSamples = 4;
/// Solid angle of an occluder about the middle of what moved: less hides little. More: work in other rooms. Less: time
/// for umbrae.
constexpr double kLeastCovered = 0.05;

}  // namespace deltalux::paper::tuning
