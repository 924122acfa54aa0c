#pragma once
// Tuned constants that several layers share: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::tuning {

/// Error that numbers of rays, lines and widths are given for: it scales them to the error that is asked for.
constexpr double kUsualError = 0.05;
/// Share of the mean of all, of what a path began with, or of full size, below which something is as good as nothing.
/// Larger: dark corners are off, faint reflections end. Smaller: work for what nobody sees.
constexpr float kNegligible = 1e-3f;
/// Power that changes in the last pass of light over what it is exchanged by, relative to emitted, where it has begun
/// with nearly all there is. Larger: dark corners are too dark.
constexpr double kConvergedAgain = 1e-5;
/// Radii beyond which something is far: drawn by its area alone, linked without another look, or a few points. Less:
/// noise and errors where things are close. More: work for what is alike.
constexpr double kFar = 3;
/// Share of the chances that goes to what an estimate takes for nothing. Less: white specks where it was wrong. More:
/// samples where there is nothing.
constexpr float kDefensive = 0.05f;
/// Rays or points that give a first idea of a place, where more follow or little depends on it; points along each
/// parameter, or rings of directions, by which a pattern of light is looked at. Fewer: splits and choices by chance,
/// and what varies is taken for constant. More: time before the first light.
constexpr int kPilots = 16;
/// Independent estimates before any judgement by their spread. Fewer: standard errors by chance. More: time where all
/// is simple.
constexpr int kFewestEstimates = 32;
/// Bounces after which a first idea of light ends; of a path, whose numbers are stratified. Fewer: rooms that are lit
/// from rooms beside them count as dark, and noise.
constexpr int kPilotBounces = 4;
/// Halvings of a sky, or of a lamp at most, into cells for particles and shadow rays to choose of. Fewer: noise under
/// an uneven sky. More: time to plan.
constexpr int kSkyHalvings = 8;
/// Events after which paths end by chance whatever they carry, and the greatest chance to go on, so that light caught
/// between perfect surfaces ends some day. Later, more: time in halls of mirrors. Sooner, less: noise.
constexpr int kRouletteFrom = 8;
constexpr double kMostSurvival = 0.9;
/// Octaves between sizes, errors or distances that are tried one after the other, or count as one. Larger: what is cut
/// by them is coarse, and time is left over. Smaller: what differs a little is cut otherwise.
constexpr double kOctaveStep = 0.25;
/// Boxes that stand for all that an edit moves. Fewer: more is looked at again. More: each look takes longer.
constexpr std::size_t kBoxes = 8;
/// Cosine between triangles that are one smooth surface. Less: edges of boxes are smoothed. More: facets of balls show.
constexpr float kSmooth = 0.7071f;

}  // namespace deltalux::tuning
