#pragma once
// Luminaires of ANSI/IES TM-33 in XML, as of 2018 and 2023, by whichever of its names: IESTM33, IESTM33-18, IESTM33-22,
// ATLA_S001, UNI11733. [TM-33]
//
// What counts is LuminousIntensity, in candela by the angles h and v of type C, in any order. Its symmetry (Symm) is
// the one that the angles fulfil; Multiplier applies. Several emitters shine together. Quantity multiplies nothing: an
// emitter's intensities are those of all its lamps. Where AbsolutePhotometry is false, intensities are of lamps that
// give RatedLumens, times BallastFactor; where they agree with LuminousFlux per 1000 lm alone, as in files made from
// EULUMDAT without a thought, they are taken so. Angles below 0 are of the goniometer's type A or B; programs that
// write no such angles name a type at random, so it counts for nothing else. Spectra, radiant and photon data are not
// light to the eye and left out.
#include <string>
#include <string_view>

#include "io/ies.hpp"

namespace deltalux::io {

/// Whether a file of that name and text is to be read as one.
bool isTm33(const std::string& name, std::string_view text);

/// Of the text of a file called `name` in messages. Throws InputError with the line of what is wrong.
PhotometryFile readTm33(std::string_view text, const std::string& name);

}  // namespace deltalux::io
