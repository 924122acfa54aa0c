#pragma once
// The tuned constants of pictures and meters: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::rendering::tuning {

/// Relative difference of leaves that asks whether something stands between. More: light leaks below walls. Less: rays.
constexpr float kDisagree = 0.3f;
/// Height above a surface at which that is looked for, in the smaller leaf's size. Less: bumps hide. More: thresholds
/// do not.
constexpr float kLift = 0.1f;
/// Joined leaves that tell what is out of the way, and the share of a leaf that tells too little of what is around it.
/// Fewer, less: single bright or dark leaves show. More: what is small and bright is lost.
constexpr std::uint32_t kFewestWitnesses = 4;
constexpr float kLittleExposed = 0.2f;
/// Passes that average leaves within their noise: they reach about as many leaves. Fewer: grain. More: blur.
constexpr int kQuietPasses = 4;
/// Noise of leaves that is averaged, times the error that was asked for. Less: grain. More: blur.
constexpr float kNoise = 2;
/// Predictions stay within so many times what the neighbours differ. Less: edges of rooms are flat. More: wild ones
/// show.
constexpr float kLeeway = 2;
/// Where the weight of a leaf in reconstruction vanishes, in its half sizes. Less: leaves show. More: blur.
constexpr float kReach = 2.5f;

/// Pixels a side of what learns together where light comes from. Fewer: rays to learn. More: what is learned fits none.
constexpr int kTile = 32;
/// Rays over those to learn from. More: grain beside windows. Fewer: time.
constexpr int kLearningShare = 2;

/// Sectors around a point that particles are looked for in. Fewer: blurred edges of caustics. More: grain.
constexpr int kSectors = 8;

/// Connections of a path to lights by way of a mirror or a ball, at most, and no more pairs of them; more would dilute
/// the choice: the rest is found by scattering. Fewer: noise below many mirrors.
constexpr std::size_t kMostSingle = 2048;
/// Steps between which roots of paths over curved mirrors and balls are looked for. Fewer: caustics with holes.
constexpr int kRootSteps = 64;
/// Inner reflections of a ball that are connected through. Fewer: noise of rainbows. More: time for what is dim.
constexpr int kMostInner = 3;
/// Added to a facing's cosine where connections are chosen: its surfaces need not face exactly there. Less: specks.
constexpr double kAskew = 0.15;
/// Test samples behind the choice of connections, at most: for pictures, and for a meter in space. Fewer: noise where
/// light comes by many ways. More: time before the first path.
constexpr double kMostTests = 4e7, kMeterTests = 1e6;
/// Connections of a meter's own point. Fewer: noise. More cost as much as they gain.
constexpr int kMeterConnections = 2;

/// Depth of a neighbour over a sample's from which it stands before it. Higher: holes in slanting surfaces. Lower: what
/// is hidden shines through. [WDP99 4.2]
constexpr float kNearer = 0.9f;
/// How well a pixel is known that is filled from all around. More: rays go elsewhere, and holes stay.
constexpr float kWithinReach = 0.3f;
/// Rays of a pixel that are averaged or learned from, at most, and frames until a sample is old. Fewer: grain, and rays
/// for what is known. More: what has changed is seen late.
constexpr std::uint16_t kMostRays = 64;
/// Frames until a ray is asked for again. Fewer: rays twice. More: holes where one was lost.
constexpr std::uint32_t kAwaited = 4;
/// Priority of an old sample, or of a pixel filled from all around, and of a young or noisy one, where nothing there is
/// 1. Higher: holes stay. Lower: what stands is never better.
constexpr float kOld = 0.5f, kYoung = 0.1f;

/// How far flat pieces may be off a curved surface, in the scene's size. More: corners show. Less: triangles.
constexpr double kSagitta = 3e-5;

}  // namespace deltalux::rendering::tuning
