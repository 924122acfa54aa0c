#pragma once
// The tuned constants of direct light by keyed shadow rays: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::direct::tuning {

/// Shadow rays of a leaf at the usual error: to the sun, to a lamp where rays disagree, to those that are drawn; and
/// points that the unshadowed light of a lamp is averaged over. Fewer: shadows are grainy, and light near lamps.
constexpr int kRays = 16;
/// Rays to the sun that tell whether others disagree: where they do, all that a patch has points for. Fewer: penumbrae
/// and edges of sunlight are grainy.
constexpr int kSunPilots = 8;
/// The same to a lamp. As many as tell whether others are worth it are taken of those that are drawn, and left where
/// none of these passes. One is enough where it hardly matters, or where all rays of the patch have missed it that this
/// one is a part of. At a patch that is kept as none of all before has seen the lamp, as many again, and twice as many
/// where it may bring most of what is not known. Fewer: lamps' shadows are grainy; edges of light are noticed late;
/// specks where light comes through narrow gaps. More: rays at walls.
constexpr int kLampPilots = 3;
/// A lamp matters where, unshadowed, it brings more than this share of what has been found; one that is asked first, of
/// what all may bring; less of a sky's cell is not told from it. Higher: faint lamps' shadows are lost.
constexpr double kMatters = 0.01;
/// Lamps that are asked one by one: those that may bring more than such a share of what all may bring, less by a factor
/// where the patch has seen them which this one is a part of; where none above has asked, all that may matter. The
/// others are drawn by what they may bring. More, less: noise where many lamps are equally bright. Less, more: rays to
/// lamps that hardly matter.
constexpr double kAskedShare = 1.0 / 32, kSeenRank = 16;
/// Split where direct light varies over quadrants, times area, by more than this many errors of the light there.
/// Higher: shadows' edges are blurred.
constexpr double kVariation = 2;
/// Side of the area that variation is weighed against, in mean distances of the leaf's lines; times the error, the area
/// of the finest leaf that is split. Larger: small bright spots are averaged away.
constexpr double kScale = 0.15;
/// Widest leaf in a narrow beam, in the beam's widths. Wider: the beam falls between samples.
constexpr double kBeam = 0.75;
/// Full angle below which a beam is narrow, and a sky is taken whole [radians]. Wider: rays of a low sun's glow go
/// anywhere in it.
constexpr double kNarrow = 1.0;
/// Light below which variation is not looked for, in shares of the scene's mean irradiance.
constexpr double kFloor = 0.02;

/// Lines or rays that what was thought before counts for: of what is seen of a cell of the sky, of the light of a
/// square of a source. Fewer: a few by chance take it for dark, and slots get no rays. More: where light comes from is
/// learned late.
constexpr float kPrior = 2;

/// Most that one shadow ray of a point may bring where its light is thought to be hidden, in shares of the light there,
/// and how many times as many rays that may cost. Higher: white specks. Lower: rays into what is hidden.
constexpr float kSpeck = 8;
constexpr float kMostGrowth = 1.5f;
/// Most of a point's rays that one square of a source gets. More: where the sun is hidden, all else is grain.
constexpr float kMostShare = 0.25f;
/// Rays of one independent estimate of a meter. Fewer: standard errors by chance.
constexpr int kEstimateRays = 64;

}  // namespace deltalux::direct::tuning
