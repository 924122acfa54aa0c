#pragma once
// Measured light distributions, IES LM-63 of 1986, 1991, 1995, 2002 and 2019, photometric types A, B and C; EULUMDAT in
// files that are named so is read by ldt.hpp, TM-33, which is XML, by tm33.hpp.
//
// Type C is completed by its lateral symmetry; A and B are resampled to type C (io/ies/complete.hpp). What the standard
// says is applied: candela multiplier, ballast factor, ballast-lamp factor (before 1995; the field has had other
// meanings since), and the lamp's TILT factor at 0 degrees, that is, for a luminaire mounted as it was
// measured. Numbers may break lines anywhere and are told apart by blanks, commas or line ends of any system.
#include <deltalux/light.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

struct PhotometryFile {
  Photometry photometry;
  std::vector<std::string> warnings;  // what was mended or looks doubtful, one line each
};

/// Reads the text of a file called `name` in messages; a tilt file named in it is looked for in `folder`. Throws
/// InputError with the line.
PhotometryFile readPhotometry(std::string_view text, const std::string& name, const std::filesystem::path& folder);

}  // namespace deltalux::io
