#pragma once
// The tuned constants of particles: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::particles::tuning {

/// Shares of the flux of a link that is not refined, from which unevenness counts. More: few particles where caustics
/// are sharp. Less: many links.
constexpr double kMuch = 8;
/// Spread of pilots, relative to their mean, that is worth a refinement. Less, more: as above.
constexpr double kUneven = 0.5;
/// Share of the mean around a cell that it is taken to send at least: what its points missed may still be there. Less:
/// bright specks. More: particles from the dark.
constexpr double kAround = 0.5;
/// Reflectance of every diffuse surface where particles are planned, so that repainting leaves them as they are.
/// Higher, lower: more, fewer particles from what is lit by others.
constexpr double kNominalReflectance = 0.5;
/// Cells of receivers that the area of the whole scene would make, and how many times more of lamps, fewer of diffuse
/// senders. Fewer: particles that miss, and grain. More: time to plan.
constexpr double kCellsOfScene = 4096, kFinerLamps = 4;
/// Share of what a path began with that is still followed without a question. More: noise. Less: time for little.
constexpr double kWorth = 0.25;
/// Noise of a histogram counts so much more than for placing particles. Less: leaves that show grain.
constexpr double kClearly = 1.5;
/// Depth of sides whose particles textures show: enough to send their light on. More: elements for nothing.
constexpr int kShownDepth = 5;

}  // namespace deltalux::particles::tuning
