#include "support/reference_values.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace deltalux::test {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

}  // namespace

std::vector<ReferenceValue> readReferenceValues(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  if (!file) throw std::runtime_error("cannot read " + csv.string());
  std::map<std::string, std::size_t> column;
  std::vector<ReferenceValue> values;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> fields = split(line);
    if (column.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) column[fields[i]] = i;
      continue;
    }
    const auto number = [&](const char* name) { return std::stod(fields.at(column.at(name))); };
    ReferenceValue v;
    v.point.position = {number("x"), number("y"), number("z")};
    v.point.normal = {number("nx"), number("ny"), number("nz")};
    v.irradiance = {number("E_r"), number("E_g"), number("E_b")};
    v.standardError = {number("se_r"), number("se_g"), number("se_b")};
    const char* const region = column.contains("surface") ? "surface" : column.contains("name") ? "name" : "surface_id";
    v.region = fields.at(column.at(region));
    const auto bar = v.region.find('|');
    if (bar != std::string::npos) v.region = v.region.substr(bar + 1);
    values.push_back(v);
  }
  return values;
}

void Agreement::add(const ReferenceValue& expected, const ProbeResult& measured) {
  for (int c = 0; c < 3; ++c) {
    const double error = std::hypot(expected.standardError[c], measured.standardError[c]);
    const double difference = measured.irradiance[c] - expected.irradiance[c];
    if (!(error > 0)) continue;
    const double z = difference / error;
    ++values, within3 += std::abs(z) <= 3;
    sumZ += z, sumZ2 += z * z, sumRelative += difference / expected.irradiance[c];
  }
}

double Agreement::rmsZ() const { return values ? std::sqrt(sumZ2 / values) : 0.0; }

std::map<std::string, Agreement> compare(const std::vector<ReferenceValue>& expected,
                                         const std::vector<ProbeResult>& measured) {
  std::map<std::string, Agreement> result;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    result["all"].add(expected[i], measured[i]);
    result[expected[i].region].add(expected[i], measured[i]);
  }
  return result;
}

}  // namespace deltalux::test
