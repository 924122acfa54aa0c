#include "export/page_points.hpp"

#include <algorithm>

namespace deltalux::exporting {

namespace {

constexpr double kRoughError = 0.1;  // of the first reading: the second one has the error asked for [limit]
constexpr int kRoughSamples = 1024;  // the same [limit]

}  // namespace

std::vector<Rgb> groupAtPoints(const SolutionReader& light, std::span<const ProbePoint> points,
                               std::span<const Rgb> whole, const ProbeSettings& settings) {
  ProbeSettings rough = settings;
  rough.error = std::max(settings.error, kRoughError), rough.maxSamples = std::min(settings.maxSamples, kRoughSamples);
  const std::vector<ProbeResult> first = light.probe(points, rough);
  std::vector<Rgb> out;
  std::vector<ProbePoint> again;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    out.emplace_back(first[i].irradiance);
    const double seen = std::max(gray(first[i].standardError), kRoughError * gray(first[i].irradiance));
    if (seen > settings.error * std::max(double(gray(whole[i])), gray(first[i].irradiance)))
      again.push_back(points[i]), numbers.push_back(i);
  }
  if (again.empty()) return out;
  const std::vector<ProbeResult> second = light.probe(again, settings);
  for (std::size_t k = 0; k < again.size(); ++k) out[numbers[k]] = Rgb(second[k].irradiance);
  return out;
}

std::vector<ProbePoint> pointsOf(const std::vector<PageGrid>& grids) {
  std::vector<ProbePoint> points;
  for (const PageGrid& grid : grids) points.insert(points.end(), grid.points.begin(), grid.points.end());
  return points;
}

}  // namespace deltalux::exporting
