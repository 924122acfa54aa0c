#pragma once
// What figures have in common.
#include <cmath>
#include <string>

namespace deltalux::exporting {

/// Plain text as it stands in XML.
inline std::string inXml(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return safe;
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above x > 0.
inline double roundBelow(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double m : {5.0, 2.0})
    if (m * power <= x) return m * power;
  return power;
}

}  // namespace deltalux::exporting
