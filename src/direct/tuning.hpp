#pragma once
// The tuned constants of direct light by keyed shadow rays: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::direct::tuning {

/// Shadow rays of a leaf at the usual error: to the sun, to a lamp where rays disagree, to those that are drawn; and
/// points that the unshadowed light of a lamp is averaged over. Fewer: shadows are grainy, and light near lamps.
constexpr int kRays = 16;
/// The same to a sky, and to lamps that are drawn where rays disagree. Fewer: grain beside windows, and where many
/// faint lamps shine.
constexpr int kManyRays = 32;
/// Rays to the sun that tell whether others disagree, and how many more where they do. Fewer: penumbrae and edges of
/// sunlight are grainy.
constexpr int kSunPilots = 8, kMixedSunRays = 56;
/// The same to a lamp; how many where all agree, which are as many as tell whether others are worth it of those that
/// are drawn, or that are left where none of these passes; and how many where it hardly matters, or where all rays of
/// the patch have missed it that this one is a part of. Fewer: lamps' shadows are grainy; edges of light are noticed
/// late. More: rays at walls.
constexpr int kLampPilots = 3, kLampRays = 4, kFaintRays = 1;
/// A lamp matters where, unshadowed, it brings more than this share of what has been found. Higher: faint lamps'
/// shadows are lost.
constexpr double kMatters = 0.01;
/// Share of the light there from which on unshadowed light of a lamp is averaged over four times as many points where
/// it is near or not all lie in its beam; and how near that is, in radii of both. More, less: grain near lamps.
constexpr double kMuch = 0.1;
constexpr float kNearBy = 8;
/// Lamps that are asked one by one, those that may bring more than such a share of what all may bring, less where the
/// patch is a part of none that has asked, and by a factor where that has seen them; the others are drawn by what they
/// may bring. Fewer, more: noise where many lamps are equally bright. More, less: rays to lamps that hardly matter.
constexpr std::size_t kLampsAsked = 24;
constexpr double kAskedShare = 1.0 / 32, kFirstShare = 1.0 / 256, kSeenRank = 16;
/// Rays that tell the light of a lamp at a patch that is kept as none of all before has seen it, where it may bring
/// most of what is not known; of the sun, and of those that are drawn where the patch above has missed them. Fewer:
/// specks where light comes through narrow gaps. More: rays at walls.
constexpr int kUnseenRays = 6, kFewRays = 2;
/// Split where direct light varies over quadrants, times area, by more than this many errors of the light there.
/// Higher: shadows' edges are blurred.
constexpr double kVariation = 2;
/// Side of the area that variation is weighed against, in mean distances of the leaf's lines, and the area of the
/// finest leaf that is split in those, times the error. Larger: small bright spots are averaged away.
constexpr double kScale = 0.15, kFinest = 1;
/// Widest leaf in a narrow beam, in the beam's widths. Wider: the beam falls between samples.
constexpr double kBeam = 0.75;
/// Full angle below which a beam is narrow [radians].
constexpr double kNarrow = 1.0;
/// Light below which variation is not looked for, in shares of the scene's mean irradiance.
constexpr double kFloor = 0.02;

/// Cells of the sphere that visibility estimates are kept by: along height, and as many around. Fewer: rays beside the
/// window. More: cells that hardly any line tells of.
constexpr int kSkySide = 16;
/// Directions that the width of a lamp's beam is found by: polar angles, and azimuths of each. Fewer: narrow beams are
/// taken for wide.
constexpr int kBeamRings = 48, kBeamAround = 16;
/// Lines that tell visibility below one element. Fewer: guides of chance.
constexpr int kGuideLines = 4096;
/// Prior of a cell's visibility estimate: lines, and those of them that leave the scene; and the least estimate, of a
/// cell that no line leaves the scene by. Less: what few lines have seen is believed, and slots get no rays.
constexpr float kLinesPrior = 2, kOpenPrior = 0.1f, kLeastOpen = 1.0f / 64;

/// Most that one shadow ray of a point may bring where its light is thought to be hidden, in shares of the light there,
/// and how many times as many rays that may cost. Higher: white specks. Lower: rays into what is hidden.
constexpr float kSpeck = 8;
constexpr float kMostGrowth = 1.5f;
/// Rounds of learning where light comes from, each looking where the one before saw it, and the rays that a point of
/// its own learns from. Fewer: grain beside windows and in penumbrae.
constexpr int kLearningRounds = 3, kLearnAtPoint = 768;
/// Chance that a lamp is seen, before any ray is known. Lower: white specks where it is.
constexpr float kOpenLamp = 0.5f;
/// Half angle below which a sky is taken whole [radians]. Wider: rays of a low sun's glow go anywhere in it.
constexpr double kNarrowSky = 0.25;
/// Most of a point's rays that one square of a source gets. More: where the sun is hidden, all else is grain.
constexpr float kMostShare = 0.25f;
/// Rays that what was thought of a square before counts for. Fewer: a few rays by chance take it for dark.
constexpr float kDoubt = 2;
/// A square is divided from so many rays on, where the variance between its quarters is so many times that within;
/// not below this side, in shares of the source, nor where it gets a negligible share of all rays. Fewer, less: squares
/// by chance. More: rays at the wall around the window.
constexpr std::size_t kFewestLooks = 6;
constexpr double kUneven = 3, kSmallest = 1.0 / 64;
/// Rays of one independent estimate of a meter, and estimates before any judgement. Fewer: standard errors by chance.
constexpr int kBatch = 64, kFewestBatches = 8;

}  // namespace deltalux::direct::tuning
