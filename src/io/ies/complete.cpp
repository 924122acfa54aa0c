#include "io/ies/complete.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>

namespace deltalux::io {

namespace {

constexpr double kDegree = kPi / 180;  // [defined]
constexpr double kStep = 1e-6;  // width [degrees] of the step from the last measured angle to darkness [rounding]
constexpr const char* kAnglesHint = "get the file again from the maker, or correct its angles";

std::string angleText(double degrees) {
  std::string text = std::to_string(degrees);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

InputError badAngles(const IesRecord& record, const std::string& name, const std::string& message) {
  return InputError(name, record.anglesLine, message, kAnglesHint);
}

// One plane of the completed distribution and the measured plane that it repeats.
struct Plane {
  double horizontal;
  std::size_t source;
};

std::vector<Plane> fullCircle(const IesRecord& record, const std::string& name) {
  const std::vector<double>& h = record.horizontals;
  const double first = h.front(), last = h.back();
  if (h.size() == 1) return {{0, 0}, {360, 0}};

  std::vector<Plane> planes;
  const auto add = [&](double angle, std::size_t source) {
    angle -= 360 * std::floor(angle / 360);
    planes.push_back({angle, source});
  };
  const bool quadrant = first == 0 && last == 90;
  const bool half = first == 0 && last == 180;
  const bool sideways = first == 90 && last == 270;
  const bool circle = (first == 0 && last > 180 && last <= 360) || last - first == 360;
  if (!quadrant && !half && !sideways && !circle) {
    throw badAngles(record, name,
                    "the horizontal angles run from " + angleText(first) + " to " + angleText(last) +
                        "; type C knows 0 alone, 0-90, 0-180, 90-270 and 0-360");
  }
  for (std::size_t i = 0; i < h.size(); ++i) {
    add(h[i], i);
    if (quadrant || sideways) add(180 - h[i], i);
    if (quadrant || half) add(-h[i], i);
    if (quadrant) add(180 + h[i], i);
  }
  std::stable_sort(planes.begin(), planes.end(), [](Plane a, Plane b) { return a.horizontal < b.horizontal; });
  const auto same = [](Plane a, Plane b) { return a.horizontal == b.horizontal; };
  planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
  // A circle that does not start at 0 comes round from its last plane.
  if (planes.front().horizontal > 0) planes.insert(planes.begin(), {0, planes.back().source});
  planes.push_back({360, planes.front().source});
  return planes;
}

// Appends the vertical angles below and above the measured range, dark.
void coverVerticals(std::vector<double>& verticals, bool& darkBelow, bool& darkAbove) {
  darkBelow = verticals.front() > 0;
  darkAbove = verticals.back() < 180;
  if (darkBelow) verticals.insert(verticals.begin(), {0.0, verticals.front() - kStep});
  if (darkAbove) {
    const double last = verticals.back();
    if (last + kStep < 180) verticals.push_back(last + kStep);
    verticals.push_back(180);
  }
}

Photometry completeTypeC(IesRecord& record, const std::string& name) {
  const double first = record.verticals.front(), last = record.verticals.back();
  if ((first != 0 && first != 90) || last > 180) {
    throw badAngles(record, name,
                    "the vertical angles run from " + angleText(first) + " to " + angleText(last) +
                        "; type C starts at 0 or 90 and ends at 90 or 180");
  }
  if (last != 90 && last != 180) {
    record.warnings.push_back(name + ": vertical angles end at " + angleText(last) + "; nothing shines beyond");
  }
  const std::vector<Plane> planes = fullCircle(record, name);
  Photometry photometry;
  photometry.verticals = record.verticals;
  bool darkBelow = false, darkAbove = false;
  coverVerticals(photometry.verticals, darkBelow, darkAbove);
  const std::size_t measured = record.verticals.size();
  for (const Plane& plane : planes) {
    photometry.horizontals.push_back(plane.horizontal);
    const auto begin = record.candela.begin() + static_cast<std::ptrdiff_t>(plane.source * measured);
    if (darkBelow) photometry.candela.insert(photometry.candela.end(), 2, 0.0);
    for (auto value = begin; value != begin + static_cast<std::ptrdiff_t>(measured); ++value) {
      photometry.candela.push_back(*value * record.multiplier);
    }
    photometry.candela.resize(photometry.horizontals.size() * photometry.verticals.size(), 0.0);
  }
  return photometry;
}

// Bilinear in the file's own angles; 0 outside.
double interpolate(const IesRecord& record, double vertical, double horizontal) {
  const auto locate = [](const std::vector<double>& angles, double angle, std::size_t& index, double& fraction) {
    constexpr double kSlack = 1e-9;  // [rounding]
    if (angle < angles.front() - kSlack || angle > angles.back() + kSlack) return false;
    if (angles.size() == 1) return index = 0, fraction = 0, true;
    const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
    index = static_cast<std::size_t>(above - angles.begin()) - 1;
    fraction = std::clamp((angle - angles[index]) / (angles[index + 1] - angles[index]), 0.0, 1.0);
    return true;
  };
  std::size_t v = 0, h = 0;
  double fv = 0, fh = 0;
  if (!locate(record.verticals, vertical, v, fv) || !locate(record.horizontals, horizontal, h, fh)) return 0;
  const auto at = [&](std::size_t i, std::size_t j) { return record.candela[i * record.verticals.size() + j]; };
  const double here = (1 - fv) * at(h, v) + fv * at(h, v + 1);
  const double next = fh > 0 ? (1 - fv) * at(h + 1, v) + fv * at(h + 1, v + 1) : here;
  return (1 - fh) * here + fh * next;
}

// The angles of types A and B, vertical first, for a direction given by type C angles. [LM-63, 2002; EXT_lights_ies]
std::pair<double, double> anglesOf(PhotometricType type, double vertical, double horizontal) {
  const double sine = std::sin(vertical * kDegree);
  const double x = sine * std::cos(horizontal * kDegree);
  const double y = sine * std::sin(horizontal * kDegree);
  const double down = vertical == 90 ? 0.0 : std::cos(vertical * kDegree);
  const auto latitude = [](double s) { return std::asin(std::clamp(s, -1.0, 1.0)) / kDegree; };
  const auto longitude = [&](double s) { return s == 0 && down == 0 ? 0.0 : std::atan2(s, down) / kDegree; };
  if (type == PhotometricType::A) return {latitude(x), longitude(-y)};
  return {longitude(x), latitude(-y)};
}

double finestStep(const IesRecord& record) {
  double step = 5;
  for (const std::vector<double>* angles : {&record.verticals, &record.horizontals}) {
    for (std::size_t i = 1; i < angles->size(); ++i) step = std::min(step, (*angles)[i] - (*angles)[i - 1]);
  }
  return 90 / std::round(90 / std::clamp(step, 0.5, 5.0));
}

void checkPolarAngles(const IesRecord& record, const std::string& name) {
  const auto beyond = [](const std::vector<double>& angles, double limit) {
    return angles.front() < -limit || angles.back() > limit;
  };
  const bool typeA = record.type == PhotometricType::A;
  if (beyond(record.verticals, typeA ? 90 : 180) || beyond(record.horizontals, typeA ? 180 : 90)) {
    throw badAngles(record, name, std::string("the angles are not those of photometric type ") + (typeA ? "A" : "B"));
  }
}

Photometry resampleToTypeC(const IesRecord& record, const std::string& name) {
  checkPolarAngles(record, name);
  const double step = finestStep(record);
  const int quarter = static_cast<int>(std::lround(90 / step));
  Photometry photometry;
  // The rim of the front half stands for the many files that stop there: a step, not a ramp.
  for (int i = 0; i <= 2 * quarter; ++i) {
    photometry.verticals.push_back(step * i);
    if (i == quarter) photometry.verticals.push_back(90 + kStep);
  }
  for (int i = 0; i <= 4 * quarter; ++i) photometry.horizontals.push_back(step * i);
  const bool axial = record.horizontals.size() == 1;
  for (const double horizontal : photometry.horizontals) {
    for (const double vertical : photometry.verticals) {
      auto [v, h] =
          axial ? std::pair{vertical, record.horizontals.front()} : anglesOf(record.type, vertical, horizontal);
      if (record.verticals.front() == 0) v = std::abs(v);
      if (!axial && record.horizontals.front() == 0) h = std::abs(h);
      photometry.candela.push_back(interpolate(record, v, h) * record.multiplier);
    }
  }
  return photometry;
}

}  // namespace

Photometry completePhotometry(IesRecord& record, const std::string& name) {
  Photometry photometry =
      record.type == PhotometricType::C ? completeTypeC(record, name) : resampleToTypeC(record, name);
  // Negative dimensions mark round openings.
  photometry.opening = {record.width, record.length, std::abs(record.height)};
  return photometry;
}

}  // namespace deltalux::io
