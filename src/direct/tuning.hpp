#pragma once
// The tuned constants of direct light by keyed shadow rays: purpose, unit, normal value, and what breaks.

namespace deltalux::direct::tuning {

/// Rays to a lamp that tell whether others disagree. As many as tell whether others are worth it are taken of those
/// that are drawn, and left where none of these passes. One is enough where it hardly matters, or where all rays of the
/// patch have missed it that this one is a part of. At a patch that is kept as none of all before has seen the lamp, as
/// many again, and twice as many where it may bring most of what is not known. Fewer: lamps' shadows are grainy; edges
/// of light are noticed late; specks where light comes through narrow gaps. More: rays at walls.
constexpr int kLampPilots = 3;
/// A lamp matters where, unshadowed, it brings more than this share of what has been found; one that is asked first, of
/// what all may bring; less of a sky's cell is not told from it. Higher: faint lamps' shadows are lost.
constexpr double kMatters = 0.01;
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

}  // namespace deltalux::direct::tuning
