#include "export/plan_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "export/drawing.hpp"

namespace deltalux::exporting {

namespace {
constexpr int kLevels = 7;            // lines of equal illuminance at most [layout]
constexpr double kMostDecades = 1.5;  // of the scale of colours [shown]
}  // namespace

PlanField::PlanField(const MeasuringGrid& grid, std::span<const double> lux)
    : columns_(grid.columns), rows_(grid.rows) {
  lux_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
  for (std::size_t i = 0; i < lux.size(); ++i) lux_[grid.cells[i]] = lux[i];
}

double PlanField::at(double x, double y) const {
  const int i = std::clamp(static_cast<int>(std::floor(x)), 0, columns_ - 1);
  const int j = std::clamp(static_cast<int>(std::floor(y)), 0, rows_ - 1);
  if (cell(i, j) < 0) return -1;
  const double u = std::clamp(x - 0.5, 0.0, columns_ - 1.0), v = std::clamp(y - 0.5, 0.0, rows_ - 1.0);
  const int a = std::min(static_cast<int>(u), std::max(columns_ - 2, 0)),
            b = std::min(static_cast<int>(v), std::max(rows_ - 2, 0));
  double sum = 0, weights = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int c = std::min(a + dx, columns_ - 1), r = std::min(b + dy, rows_ - 1);
      const double w = (dx ? u - a : 1 - u + a) * (dy ? v - b : 1 - v + b);
      if (cell(c, r) >= 0) sum += w * cell(c, r), weights += w;
    }
  return weights > 0 ? sum / weights : cell(i, j);
}

std::vector<double> levelsOf(const GridStatistics& s) {
  std::vector<double> levels;
  const double span = s.most - s.least;
  if (!(span > 0)) return levels;
  double step = roundBelow(span / 3);
  while (span / step > kLevels) step *= 2;
  for (double level = step * std::ceil(s.least / step); level < s.most; level += step)
    if (level > s.least) levels.push_back(level);
  return levels;
}

FalseColorSettings coloursOf(const GridStatistics& s, double decades) {
  FalseColorSettings settings;
  settings.decades = kMostDecades;
  if (!(s.most > 0)) return settings;
  settings.top = roundBelow(s.most);
  for (const double m : {2.0, 2.5, 2.0})
    if (settings.top < s.most) settings.top = roundBelow(m * settings.top * (1 + 1e-9));
  if (s.least > 0) settings.decades = std::clamp(std::log10(settings.top / s.least) + 0.05, decades, kMostDecades);
  return settings;
}

std::vector<Segment> lineAt(const PlanField& field, double level) {
  std::vector<Segment> line;
  const auto triangle = [&](const std::array<Vec2, 3>& p) {
    std::array<double, 3> E;
    for (std::size_t i = 0; i < 3; ++i) E[i] = field.cell(static_cast<int>(p[i].x), static_cast<int>(p[i].y));
    if (*std::ranges::min_element(E) < 0) return;
    std::vector<Vec2> crossings;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if ((E[i] < level) != (E[j] < level))
        crossings.push_back(p[i] + (level - E[i]) / (E[j] - E[i]) * (p[j] - p[i]) + 0.5);
    }
    if (crossings.size() == 2) line.push_back({crossings[0], crossings[1]});
  };
  for (int r = 0; r + 1 < field.rows(); ++r)
    for (int c = 0; c + 1 < field.columns(); ++c) {
      triangle({Vec2(c, r), Vec2(c + 1, r), Vec2(c + 1, r + 1)});
      triangle({Vec2(c, r), Vec2(c + 1, r + 1), Vec2(c, r + 1)});
    }
  return line;
}

}  // namespace deltalux::exporting
