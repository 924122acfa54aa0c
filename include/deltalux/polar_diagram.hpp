#pragma once
// A luminaire's measured light as designers read it: its numbers, and its intensities as a polar diagram.
#include <array>
#include <deltalux/light.hpp>
#include <filesystem>
#include <string>

namespace deltalux {

struct PhotometrySummary {
  double flux = 0;                              // [lm]
  double downwards = 0;                         // share of it below the horizontal plane through the luminaire
  double peak = 0;                              // greatest intensity [cd]
  double peakVertical = 0, peakHorizontal = 0;  // where: gamma and C [degrees]
  std::array<double, 2> halfPeak = {0.0, 0.0};  // of the planes C0-C180 and C90-C270: angle from side to side within
                                                // which the plane has half of its own greatest intensity [degrees]
};

PhotometrySummary summarize(const Photometry&);

/// The planes C0-C180 (solid) and C90-C270 (dashed) as SVG, gamma 0 downwards, circles in round numbers of candela.
/// `title` stands above it, as plain text.
std::string polarDiagram(const Photometry&, const std::string& title);

/// polarDiagram into a file, atomically. Throws OutputError.
void savePolarDiagram(const std::filesystem::path&, const Photometry&, const std::string& title);

}  // namespace deltalux
