#pragma once
// Measured light distributions, EULUMDAT of 1990 and 1998 (.ldt). [Stockmar90; Stockmar98]
//
// What the format leaves to its readers is applied: intensities are in candela per 1000 lm of the lamps, so they are
// multiplied by the flux of a set of lamps, and by the conversion factor; planes that symmetry leaves out are there. Of
// several sets of lamps the first counts. A negative number of lamps says that the flux is the luminaire's own
// (absolute photometry), by the same formula.
#include <string>
#include <string_view>

#include "io/ies/parse.hpp"

namespace deltalux::io {

/// Whether a file is named as one.
bool namesLdt(const std::string& file);

/// Of the text of a file called `name` in messages: type C, with the planes that complete.hpp completes. The 0 plane is
/// the file's C0. Throws InputError with the line of the first thing that is wrong.
IesRecord parseLdt(std::string_view text, const std::string& name);

}  // namespace deltalux::io
