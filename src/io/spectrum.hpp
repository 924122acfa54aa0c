#pragma once
// Spectra as linear colours of sRGB. White is a black body of 6504 K, next to the D65 of sRGB: under it a spectrum is
// looked at, and a flat one becomes its gray exactly. Colours beyond sRGB's are cut off at 0. [WSS13; IEC 61966-2-1]
#include <deltalux/units.hpp>
#include <utility>
#include <vector>

namespace deltalux::io {

/// Values by wavelength [nm], ascending; linear between, 0 beyond.
using Spectrum = std::vector<std::pair<double, double>>;

/// What a surface of that spectral reflectance looks like under white; also any other quantity that multiplies light.
Rgb colourOfReflectance(const Spectrum&);
/// The colour of light of that spectrum, of the luminance of Rgb(1); black if nobody sees it.
Rgb colourOfLight(const Spectrum&);
/// That of a black body [K], by Planck's law.
Rgb colourOfBlackBody(double kelvin);

}  // namespace deltalux::io
