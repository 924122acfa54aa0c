#pragma once
// The tuned constants of caustic textures: purpose, unit, normal value, and what breaks.

namespace deltalux::caustics::tuning {

/// Share of the target error that matters: differences that make an edge, a region, or a texture, noise that a kernel
/// need not grow to reduce, and from which on the low-frequency layer stands for it; of the noise of a tile's flux, or
/// of all, what is no change. More: blur; slow change is not followed. Less: grain; textures of next to nothing.
constexpr double kMatters = 0.5;
/// Narrowest and widest kernel, standard deviation in cells. Wider: time. Narrower: grain where light is dim.
constexpr double kNarrowest = 0.5, kWidest = 6;
/// Standard errors that a jump of a blurred edge has to stand out by. More: blur. Less: islands of grain.
constexpr double kConfidence = 2.25;
/// The same of a sharp edge, and of means within a distance of a point [GN97, 2.3: about 2 for Gaussian noise].
constexpr double kSharp = 1.5;
/// Standard errors by which a surface has to depart from even light to get a texture. Less: textures of noise.
constexpr double kSignificance = 4;
/// Particles that are stray: in a fine texel, or as a change. Fewer: noise taken for light. More: blur.
constexpr double kStray = 2;
/// Texels across at most of a coarse texture, by which surfaces are chosen too; of a fine one, twice as many. Fewer:
/// blur. More: time and memory in the square.
constexpr int kCoarseSide = 128;
/// Coarse texels around a region. Fewer: its outline shows.
constexpr int kMargin = 2;
/// Range of modes that are damped, as far as half of them go in a time of 1. Less: checkerboards. More: steps.
constexpr double kDamping = 1;

}  // namespace deltalux::caustics::tuning
