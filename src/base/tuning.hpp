#pragma once
// Tuned constants that several layers share: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::tuning {

/// Error that numbers of rays, lines and widths are given for: it scales them to the error that is asked for.
constexpr double kUsualError = 0.05;
/// Share of the mean of all, of what a path began with, or of full size, below which something is as good as nothing.
/// Larger: dark corners are off, faint reflections end. Smaller: work for what nobody sees.
constexpr float kNegligible = 1e-3f;
/// Share of the chances that goes to what an estimate takes for nothing. Less: white specks where it was wrong. More:
/// samples where there is nothing.
constexpr float kDefensive = 0.05f;
/// Rays or points that give a first idea of a place, where more follow or little depends on it. Fewer: splits and
/// choices by chance. More: time before the first light.
constexpr int kPilots = 16;
/// Bounces after which a first idea of light ends. Fewer: rooms that are lit from rooms beside them count as dark.
constexpr int kPilotBounces = 4;
/// Events of a path whose numbers are stratified. Fewer: noise. More gain nothing.
constexpr int kStratifiedEvents = 3;
/// Events after which paths end by chance whatever they carry, and the greatest chance to go on, so that light caught
/// between perfect surfaces ends some day. Later, more: time in halls of mirrors. Sooner, less: noise.
constexpr int kRouletteFrom = 4;
constexpr double kMostSurvival = 0.9;
/// Boxes that stand for all that an edit moves. Fewer: more is looked at again. More: each look takes longer.
constexpr std::size_t kBoxes = 8;
/// Cosine between triangles that are one smooth surface. Less: edges of boxes are smoothed. More: facets of balls show.
constexpr float kSmooth = 0.7071f;

}  // namespace deltalux::tuning
