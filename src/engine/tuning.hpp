#pragma once
// The tuned constants of solving, updating and frames: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::engine::tuning {

/// Particles at an error of one; they are as one over its square, and so many at most. Fewer: textures are blurred, and
/// caustics on the mesh are noise. More: time and memory in proportion.
constexpr double kParticlesAtUnitError = 1000, kMostParticles = 3e6;
/// Things that have a tree of their own in the tracer. Fewer: the whole is built again more often. More: rays are slow.
constexpr int kMostGroups = 16;

/// Shares of a limited time: that particles may take; after which the mesh is split no more. Larger: what comes later
/// is missing when time is up.
constexpr double kParticleTime = 0.3, kMeshTime = 0.5;

/// Of a frame, of what is left of a limited time for lines, or of all of it for links, that is planned: the rest keeps
/// it in time where work takes longer than learned. More: late frames.
constexpr double kPlanned = 0.8;
/// Leaves that follow in any frame, so that it gets on, and passes that it keeps time for. More: late frames.
constexpr std::size_t kFewestLeaves = 64;
constexpr double kPassesOfFrame = 2;
/// How much the latest cost counts for what is learned. More: one slow step makes frames poor. Less: they are late for
/// longer.
constexpr double kNewCost = 0.5;

/// Rays that measure what particles bring, and lines that measure where light ends. Fewer: the ledger closes less well.
constexpr std::size_t kLedgerSamples = 1 << 19;

/// Error of links in the first round, relative to the last. Larger: the first rounds tell little. Smaller: the first
/// picture is late.
constexpr double kFirstError = 64;
/// How many times as bright as it was a light may become before links are refined from the start. Larger: they are too
/// few for it. Smaller: brightening takes a solve.
constexpr double kBrighter = 8;

}  // namespace deltalux::engine::tuning
