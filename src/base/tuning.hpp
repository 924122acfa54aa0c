#pragma once
// Tuned constants that several layers share: purpose, unit, normal value, and what breaks.

namespace deltalux::tuning {

/// Share of the mean of all, of what a path began with, or of full size, below which something is as good as nothing.
/// Larger: dark corners are off, faint reflections end. Smaller: work for what nobody sees.
constexpr float kNegligible = 1e-3f;
/// Power that is yet to come when light has been passed on for the last time, relative to emitted, as far as the passes
/// tell. Larger: dark corners and halls of white plaster are too dark.
constexpr double kConverged = 1e-5;
/// Radii beyond which something is far: drawn by its area alone, linked without another look, or a few points. Less:
/// noise and errors where things are close. More: work for what is alike.
constexpr double kFar = 3;
/// Share of the chances that goes to what an estimate takes for nothing. Less: white specks where it was wrong. More:
/// samples where there is nothing.
constexpr float kDefensive = 0.05f;
/// Rays or points that give a first idea of a place, where more follow or little depends on it, or it is one of many
/// leaves; leaves that give one of what a leaf takes; points along each parameter, rings of directions, or cells along
/// the side of a sky, by which a pattern of light is looked at. Fewer: splits and choices by chance, grainy shadows,
/// and what varies is taken for constant. More: time before the first light, and for each lamp.
constexpr int kPilots = 16;
/// The same where all agree, or that brings little; how much more than there is at a point one ray of it may bring; and
/// leaves that tell what is out of the way. Fewer: blotchy shadows, rays into what is hidden, single leaves show. More:
/// rays at what is clear, white specks.
constexpr int kFewRays = 4;
/// Independent estimates before any judgement by their spread; rays to lamps that are drawn, so many of which may be
/// asked one by one. Fewer: standard errors by chance, noise where many lamps are equally bright. More: time where all
/// is simple.
constexpr int kFewestEstimates = 32;
/// Bounces after which a first idea of light ends; of a path, whose numbers are stratified. Fewer: rooms that are lit
/// from rooms beside them count as dark, and noise.
constexpr int kPilotBounces = 4;
/// Rounds of an estimate that looks ever closer, each at where the one before found it: where light comes from, which
/// particles are of one light. Fewer: grain beside windows and in penumbrae, edges of caustics are blurred. More: time.
constexpr int kEverCloser = 3;
/// Events after which paths end by chance whatever they carry, and lines for good; and the greatest chance to go on, so
/// that light caught between perfect surfaces ends some day. Later, more: time in halls of mirrors. Sooner, less:
/// noise, light between facing mirrors is lost.
constexpr int kRouletteFrom = 8;
constexpr double kMostSurvival = 0.9;
/// Polar angles by which a lamp's pattern is looked at: that its beam's width is found by, and that its table begins
/// with (2 degrees). Fewer: narrow beams and peaks are overlooked. More: time for each lamp.
constexpr int kPolarAngles = 90;
/// Share of the light of a surface or of a leaf beside it, of the target error, or of a depth, by which a difference is
/// a change; of a side's area that may be darker than what noise is compared with; and of a leaf that tells of what is
/// around it. More: shadows of what has moved away, dark rooms beside bright places are not done, what is hidden shines
/// through, light leaks below walls. Less: work at every edit and in dark corners, holes in slanting surfaces.
constexpr double kChangeMatters = 0.1;
/// Octaves between sizes, errors or distances that are tried one after the other, or count as one. Larger: what is cut
/// by them is coarse, and time is left over. Smaller: what differs a little is cut otherwise.
constexpr double kOctaveStep = 0.25;

}  // namespace deltalux::tuning
