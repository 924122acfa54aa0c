#pragma once
// The numbers of an LM-63 file as they stand, checked for form: counts, order of angles, finite values.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

enum class PhotometricType { C = 1, B = 2, A = 3 };  // the file's own numbers

struct IesRecord {
  int revision = 1986;  // year of the standard that the first line names
  double lampCount = 1;
  double lumensPerLamp = -1;  // -1: absolute photometry
  double outputRatio = 0;     // of the luminaire to its lamps; 0: not said
  double multiplier = 1;      // of the candelas: all factors of the file together
  PhotometricType type = PhotometricType::C;
  double width = 0, length = 0, height = 0;    // luminous opening [m], negative for round ones, 0 for none
  std::vector<double> verticals, horizontals;  // degrees, ascending
  std::vector<double> candela;                 // [h * verticals.size() + v], without the multiplier
  int anglesLine = 0;                          // where the horizontal angles stand
  std::vector<std::string> warnings;
};

/// Takes intensities below zero for none, and says so.
void mendCandela(const std::string& name, IesRecord&);

/// Throws InputError with the line of the first thing that is wrong.
IesRecord parseIes(std::string_view text, const std::string& name, const std::filesystem::path& folder);

}  // namespace deltalux::io
