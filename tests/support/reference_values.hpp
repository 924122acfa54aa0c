#pragma once
// Independent irradiance values with standard errors, and how another set compares with them.
#include <deltalux/probe.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace deltalux::test {

struct ReferenceValue {
  ProbePoint point;
  std::string region;  // the part of surface_id behind '|', or the surface
  glm::dvec3 irradiance, standardError;
};

/// Reads x,y,z,nx,ny,nz,E_r..E_b,se_r..se_b and the surface from a CSV with a header row and # comments.
std::vector<ReferenceValue> readReferenceValues(const std::filesystem::path& csv);

/// z = (measured - expected) / combined standard error, over all channels with an error.
struct Agreement {
  int values = 0, within3 = 0;
  double sumZ = 0, sumZ2 = 0;
  double sumRelative = 0;  // of measured - expected

  void add(const ReferenceValue&, const ProbeResult&);
  double fraction() const { return values ? static_cast<double>(within3) / values : 0.0; }
  double meanZ() const { return values ? sumZ / values : 0.0; }
  double rmsZ() const;
};

/// Overall under "all", and per region.
std::map<std::string, Agreement> compare(const std::vector<ReferenceValue>&, const std::vector<ProbeResult>&);

}  // namespace deltalux::test
