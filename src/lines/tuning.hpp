#pragma once
// The tuned constants of stored lines: purpose, unit, normal value, and what breaks. Everything else follows from the
// error that was asked for.

namespace deltalux::lines::tuning {

/// Lines of a leaf of mean area and power at an error of 5 %; their noise falls as one over the root. Fewer: blotches
/// on indirect light. More: time and memory in proportion.
constexpr double kBaseLines = 144;
/// Octaves of lines below and above the base. Fewer below: narrow places take most of the time. More above: large
/// leaves do.
constexpr int kFewestOctaves = -2, kMostOctaves = 4;
/// Bounces that tell how much light there is in a room that hardly any light reaches. Fewer: rooms behind a slot of a
/// millimetre are noise.
constexpr int kDimBounces = 2;
/// Least chance that a line ends on what has any diffuse part. Less: the few lines that end on metal weigh much.
constexpr float kLeastEnding = 0.2f;
/// Widest leaf, in harmonic mean distances of its lines, at an error of 5 %. Wider: indirect light is smeared out.
constexpr double kWidth = 0.4;
/// Narrowest leaf that is still split for its width, in mean distances about its surface. Narrower: corners fill with
/// leaves.
constexpr double kFinestWidth = 0.07;
/// How much wider leaves in the dark may be. Wider: dark corners are smeared out where exposure shows them.
constexpr double kDimWidth = 3;
/// Diagonal of a scene below which the widths here that are in metres are in proportion to it [m]. Less: models of
/// rooms are taken for hollows. More: rooms lit through slots stay dark.
constexpr double kSmallScene = 6;
/// Mean distance above which a place is a room [m]: no slot, however wide its surfaces, where its light is so far above
/// the floor's that leaves would not be wider, and worth lines of its own where hardly any reaches it. Larger: the
/// floor of a wide room that no lamp shines on is one leaf. Less: gaps between logs fill with leaves, dark cupboards
/// take most of the time.
constexpr double kRoom = 1;
/// Clusters that a surface is looked at below, to know what mean free paths are usual around it. Fewer: narrow places
/// and corners fill with leaves.
constexpr int kClustersUp = 3;

/// Mean distance below which a hollow where walks find no light counts as enclosed [m]. Larger: rooms that are lit
/// through a slot stay dark.
constexpr double kHollow = 0.2;

/// Passes of the symmetric scaling of rows. Fewer: more is left to the scaling that breaks reciprocity.
constexpr int kScalingPasses = 8;
/// Most and least that one leaf's exchange is scaled by, and by how much less than they should lines may end on what
/// they meet first. Wider: leaves with a handful of lines run away. Less: light of glossy rooms is lost.
constexpr float kMostScale = 4;

}  // namespace deltalux::lines::tuning
