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
/// Lines of a room that hardly any light reaches by which it counts as closed where none leads out, and as many as all
/// such rooms may have in scenes of few; otherwise how many times all other lines theirs may be. Fewer: rooms behind a
/// slot of a millimetre are noise. More: dark rooms take most of the time.
constexpr double kClosedLines = 1 << 20, kDimShare = 1.0 / 32;
/// Bounces that tell how much light there is in such a room; rounds, of which the next knows how many lines lead out.
/// Fewer: as above.
constexpr int kDimBounces = 2, kDimRounds = 2;
/// Least chance that a line ends on what has any diffuse part. Less: the few lines that end on metal weigh much.
constexpr float kLeastEnding = 0.2f;
/// Widest leaf, in harmonic mean distances of its lines, at an error of 5 %. Wider: indirect light is smeared out.
constexpr double kWidth = 0.4;
/// Narrowest leaf that is still split for its width, in mean distances about its surface. Narrower: corners fill with
/// leaves.
constexpr double kFinestWidth = 0.07;
/// How much wider leaves in the dark may be. Wider: dark corners are smeared out where exposure shows them.
constexpr double kDimWidth = 3;
/// Mean distance below which a patch lies in a slot, in its radii: it is not split for its width. Less: slots between
/// boards fill with leaves that nobody sees.
constexpr double kSlot = 0.5;
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

/// Walks that look for light from an input-level side, and their bounces; as many steps tell how wide the hollow is.
/// Fewer: slots that light reaches after some bounces are taken for closed hollows.
constexpr int kWalks = 6, kBounces = 40;
/// Mean distance below which a hollow where walks find no light counts as enclosed [m]. Larger: rooms that are lit
/// through a slot stay dark.
constexpr double kHollow = 0.2;
/// Widest side that may face such a hollow as a whole, in mean distances: of wider ones a rim may look out. Wider: rims
/// of what lies close behind something stay dark.
constexpr double kWidestHollow = 16;

/// By how much less than they should lines may end on what they meet first. More: of leaves with a handful of lines,
/// what gloss shows is taken for all around, and runs away. Less: light of glossy rooms is lost.
constexpr float kMostMissed = 1.25f;

/// Passes of the symmetric scaling of rows. Fewer: more is left to the scaling that breaks reciprocity.
constexpr int kScalingPasses = 8;
/// Most and least that one leaf's exchange is scaled by. Wider: leaves with a handful of lines run away.
constexpr float kMostScale = 4;

}  // namespace deltalux::lines::tuning
