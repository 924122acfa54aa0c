#include "io/ies.hpp"

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>

#include "io/ies/complete.hpp"
#include "io/ies/parse.hpp"
#include "io/import_file.hpp"
#include "io/ldt.hpp"
#include "io/tm33.hpp"

namespace deltalux {

namespace {

// A luminaire cannot give more light than its lamps, and gives what its output ratio says; candelas that say otherwise
// have a wrong multiplier, or were scaled twice.
void checkFlux(const io::IesRecord& record, const Photometry& photometry, const std::string& name,
               std::vector<std::string>& warnings) {
  const double rated = record.lampCount * record.lumensPerLamp;
  const double flux = luminousFlux(photometry);
  constexpr double kSlack = 1.1;  // [limit]
  const double told = record.outputRatio * rated;
  if (told > 0 && (flux > kSlack * told || kSlack * flux < told)) {
    warnings.push_back(name + ": the intensities amount to " + std::to_string(std::lround(flux)) +
                       " lm, its lamps and output ratio to " + std::to_string(std::lround(told)) +
                       " lm; check whether they are in candela per 1000 lm");
  } else if (rated > 0 && flux > kSlack * rated) {
    warnings.push_back(name + ": the candelas amount to " + std::to_string(std::lround(flux)) + " lm, its lamps to " +
                       std::to_string(std::lround(rated)) + " lm; check the candela multiplier");
  }
}

}  // namespace

}  // namespace deltalux

namespace deltalux::io {

PhotometryFile readPhotometry(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
  if (isTm33(name, text)) return readTm33(text, name);
  IesRecord record = namesLdt(name) ? parseLdt(text, name) : parseIes(text, name, folder);
  PhotometryFile file;
  file.photometry = completePhotometry(record, name);
  constexpr double kLargest = 1e15;  // lm [limit]
  if (!(luminousFlux(file.photometry) <= kLargest)) {
    throw InputError(name, 0, "its candela values are too large", "check the candela multiplier");
  }
  checkFlux(record, file.photometry, name, record.warnings);
  file.warnings = std::move(record.warnings);
  return file;
}

}  // namespace deltalux::io

namespace deltalux {

Photometry loadPhotometry(const std::filesystem::path& path, std::vector<std::string>* warnings) {
  io::PhotometryFile file = io::readPhotometry(io::readInputFile(path), path.string(), path.parent_path());
  if (warnings) warnings->insert(warnings->end(), file.warnings.begin(), file.warnings.end());
  return std::move(file.photometry);
}

}  // namespace deltalux
