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
/// Blockers of a list from which on clusters stay closed, and links below do not hand it on. More: time for boxes.
/// Fewer: rays at what is proven.
constexpr std::size_t kLongList = 48;
/// Cells of a sky that are split, before the surface they light [radians]. Larger: soft shadows of windows in steps.
/// Smaller: links to the sky without end.
constexpr float kFinestCell = 0.1f;
/// Paths of all sides together that tell what light there is before any link. Fewer: refined for light that is not
/// there.
constexpr std::uint64_t kPathBudget = 1u << 17;
/// Lights that a vertex of such a path looks at. Fewer: sides below one of many lamps count as dark.
constexpr std::size_t kPickedLights = 3;
/// Solid angle of an occluder about the middle of what moved: less hides little. More: work in other rooms. Less: time
/// for umbrae.
constexpr double kLeastCovered = 0.05;
/// Subdivisions of the input level that umbrae tell apart. Fewer, more: as above.
constexpr int kFinestHidden = 2;

}  // namespace deltalux::paper::tuning
