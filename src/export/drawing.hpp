#pragma once
// What figures have in common.
#include <cmath>
#include <deltalux/light.hpp>
#include <string>

namespace deltalux::exporting {

/// Plain text as it stands in XML.
inline std::string inXml(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return safe;
}

/// From side to side of a plane in [0, 180), through gamma 0: angle in (-180, 180] [degrees]. [cd]
inline double candelaInPlane(const Photometry& p, double plane, double angle) {
  return candela(p, std::abs(angle), angle >= 0 ? plane : plane + 180);
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above x > 0.
inline double roundBelow(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double m : {5.0, 2.0})
    if (m * power <= x) return m * power;
  return power;
}

}  // namespace deltalux::exporting
