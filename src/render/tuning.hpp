#pragma once
// The tuned constants of pictures and meters: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::rendering::tuning {

/// Passes that average leaves within their noise: they reach about as many leaves. Fewer: grain. More: blur.
constexpr int kQuietPasses = 4;
/// Predictions stay within so many times what the neighbours differ. Less: edges of rooms are flat. More: wild ones
/// show.
constexpr float kLeeway = 2;
/// Where the weight of a leaf in reconstruction vanishes, in its half sizes. Less: leaves show. More: blur.
constexpr float kReach = 2.5f;

/// Pixels a side of what learns together where light comes from. Fewer: rays to learn. More: what is learned fits none.
constexpr int kTile = 32;
/// Rays over those to learn from. More: grain beside windows. Fewer: time.
constexpr int kLearningShare = 2;

/// Connections of a path to lights by way of a mirror or a ball, at most, and no more pairs of them; more would dilute
/// the choice: the rest is found by scattering. Fewer: noise below many mirrors.
constexpr std::size_t kMostSingle = 2048;
/// Test samples behind the choice of connections, at most. Fewer: noise where light comes by many ways. More: time
/// before the first path.
constexpr double kMostTests = 4e7;
/// Connections of a meter's own point. Fewer: noise. More cost as much as they gain.
constexpr int kMeterConnections = 2;

/// Frames until a ray is asked for again. Fewer: rays twice. More: holes where one was lost.
constexpr std::uint32_t kAwaited = 4;
/// Priority of an old sample, of one that is noisy, or of a pixel filled from all around, where nothing there is 1.
/// Higher: holes stay. Lower: what stands is never better.
constexpr float kOld = 0.5f;

/// How far flat pieces may be off a curved surface, in the scene's size. More: corners show. Less: triangles.
constexpr double kSagitta = 3e-5;

}  // namespace deltalux::rendering::tuning
