#pragma once
// The tuned constants of caustic textures: purpose, unit, normal value, and what breaks.

namespace deltalux::caustics::tuning {

/// Share of the target error that matters: differences that make an edge, a region, or a texture, and noise that a
/// kernel need not grow to reduce. More: blur. Less: grain, and textures of next to nothing.
constexpr double kMatters = 0.5;
/// Of the target error, noise from which on the low-frequency layer is asked; of the noise of a tile's flux, or of all,
/// what is no change. More: grain; slow change is not followed. Less: blur; textures made for nothing.
constexpr double kNoticed = 0.25;
/// Narrowest and widest kernel, standard deviation in cells, and the factor between widths. Wider: time. Narrower:
/// grain where light is dim. Larger steps: widths that do not fit.
constexpr double kNarrowest = 0.5, kWidest = 6, kWidthFactor = 1.6;
/// The widest in the square root of the surface's area, too. More: light is spread over all of it.
constexpr double kWidestShare = 0.25;
/// Standard errors that a difference, or a jump of a blurred edge, has to stand out by. More: blur. Less: islands of
/// grain.
constexpr double kConfidence = 2.25;
/// The same of a sharp edge, and of means within a distance of a point [GN97, 2.3: about 2 for Gaussian noise].
constexpr double kSharp = 1.5;
/// Standard errors by which a surface has to depart from even light to get a texture. Less: textures of noise.
constexpr double kSignificance = 4;
/// Particles that tell how noisy they are: of a coarse texel, a kernel, a sharp edge, a surface. Fewer: noise taken for
/// light. More: blur.
constexpr double kEnough = 16;
/// The same that a kernel expects when it is asked, and those that are stray: in a fine texel, or as a change.
constexpr double kLeastExpected = 4, kStray = 2;
/// Particles of a region of its own, or of a tile that changes are looked for in. Fewer: many small textures.
constexpr double kRegion = 64;
/// Texels across: the grid that resolution starts from (and tiles across a side), at most to choose by, of a coarse
/// texture, and of a fine one. Fewer: blur. More: time and memory in the square.
constexpr int kFirstSide = 16, kChoiceSide = 48, kCoarseSide = 128, kFineSide = 256;
/// Coarse texels around a region. Fewer: its outline shows.
constexpr int kMargin = 2;
/// Part of a whole texel below which it joins a neighbour. Less: bright texels on outlines and at poles.
constexpr double kPart = 0.5;
/// What a mesh of few patches can show, in the surface's size. More: textures for what the mesh shows.
constexpr double kCoarse = 1.0 / 8;
/// Share of a side's area that may be darker than what noise is compared with. More: grain in its shadows.
constexpr double kDarkest = 0.1;
/// Range of modes that are damped, as far as half of them go in a time of 1. Less: checkerboards. More: steps.
constexpr double kDamping = 1;

}  // namespace deltalux::caustics::tuning
