#include <deltalux/plan.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deltalux/image_io.hpp>

#include "export/drawing.hpp"
#include "export/plan_field.hpp"
#include "io/atomic_file.hpp"

namespace deltalux {

namespace {

constexpr int kPixels = 640;              // of the longer side [layout]
constexpr int kMargin = 44, kScale = 90;  // around the plan; for the legend [px] [layout]
constexpr int kTints = 6;                 // squares across a cell, and of the legend a mark [layout]

struct Size {
  int width, height;
};

Size sizeOf(const MeasuringGrid& grid) {
  const double w = glm::length(grid.area.u), h = glm::length(grid.area.v), scale = kPixels / std::max(w, h);
  return {std::max(1, static_cast<int>(std::lround(w * scale))), std::max(1, static_cast<int>(std::lround(h * scale)))};
}

std::string colourAt(const DisplayImage& image, int x, int y) {
  const auto& c = image.at(x, y);
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}  // namespace

DisplayImage planImage(const Plan& plan) {
  const exporting::PlanField field(plan.grid, plan.lux);
  const auto [width, height] = sizeOf(plan.grid);
  const GridStatistics s = statisticsOf(plan.lux);
  const std::vector<double> levels = exporting::levelsOf(s);
  std::vector<double> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values.push_back(field.at((x + 0.5) / width * field.columns(), (height - y - 0.5) / height * field.rows()));
  const auto lux = [&, w = width](int x, int y) {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)];
  };
  DisplayImage shown =
      falseColor(exporting::imageOfLux(width, height, lux), exporting::coloursOf(s, exporting::kLabelled));
  const int left = shown.width - width;
  const auto above = [&](double E) { return std::ranges::upper_bound(levels, E) - levels.begin(); };
  for (int y = 0; y + 1 < height; ++y)
    for (int x = 0; x + 1 < width; ++x) {
      const double here = lux(x, y), right = lux(x + 1, y), below = lux(x, y + 1);
      if (here < 0 || right < 0 || below < 0) continue;
      if (above(here) != above(right) || above(here) != above(below)) shown.at(left + x, y) = {0, 0, 0};
    }
  return shown;
}

std::string planSvg(const Plan& plan) {
  const exporting::PlanField field(plan.grid, plan.lux);
  const auto [width, height] = sizeOf(plan.grid);
  const GridStatistics s = statisticsOf(plan.lux);
  const FalseColorSettings colours = exporting::coloursOf(s, exporting::kFewDecades);
  const int across = field.columns() * kTints, down = field.rows() * kTints;
  const double cellX = static_cast<double>(width) / field.columns(), cellY = static_cast<double>(height) / field.rows();
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n<text x=\"{2}\" y=\"18\" font-size=\"14\">{3}</text>\n"
      "<text x=\"{2}\" y=\"34\">Em {4:.4g} lx, Emin {5:.4g} lx, Emax {6:.4g} lx, U0 {7:.2f}, Ud {8:.2f}</text>\n",
      width + 2 * kMargin + kScale, height + 2 * kMargin, kMargin, exporting::inXml(plan.title), s.mean, s.least,
      s.most, s.uniformity(), s.diversity());
  const auto x = [&](double column) { return kMargin + column * cellX; };
  const auto y = [&](double row) { return kMargin + height - row * cellY; };
  const auto tint = [&](int i, int j) { return field.at((i + 0.5) / kTints, (down - j - 0.5) / kTints); };
  const DisplayImage tints = falseColor(exporting::imageOfLux(across, down, tint), colours);
  svg += "<g shape-rendering=\"crispEdges\">\n";
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i)
      if (tint(i, j) >= 0)
        svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                           kMargin + i * cellX / kTints, kMargin + j * cellY / kTints, cellX / kTints, cellY / kTints,
                           colourAt(tints, tints.width - across + i, j));
  svg += "</g>\n<g stroke=\"black\" stroke-width=\"1.2\" fill=\"none\">\n";
  std::string labels;
  for (const double level : exporting::levelsOf(s)) {
    const std::vector<exporting::Segment> line = exporting::lineAt(field, level);
    if (line.empty()) continue;
    svg += "<path d=\"";
    for (const exporting::Segment& part : line)
      svg += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x(part.a.x), y(part.a.y), x(part.b.x), y(part.b.y));
    svg += "\"/>\n";
    const exporting::Segment& middle = line[line.size() / 2];
    labels += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-weight=\"bold\" stroke=\"white\" "
        "stroke-width=\"3\" paint-order=\"stroke\">{:.4g}</text>\n",
        x(middle.a.x), y(middle.a.y) + 4, level);
  }
  svg +=
      "</g>\n<g text-anchor=\"middle\" font-size=\"9\" fill=\"#222\" stroke=\"white\" stroke-width=\"2\" "
      "paint-order=\"stroke\">\n";
  for (int r = 0; r < field.rows(); ++r)
    for (int c = 0; c < field.columns(); ++c)
      if (field.cell(c, r) >= 0)
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:.0f}</text>\n", x(c + 0.5), y(r + 0.5) + 3,
                           field.cell(c, r));
  svg += "</g>\n" + labels;
  // The legend: the scale of colours from bottom to top.
  const int bar = std::min(height, 240), steps = 8 * kTints;
  const auto value = [&](int, int j) { return colours.top * std::pow(10, -colours.decades * (j + 0.5) / steps); };
  const DisplayImage ramp = falseColor(exporting::imageOfLux(1, steps, value), colours);
  const double left = kMargin + width + 20;
  for (int j = 0; j < steps; ++j)
    svg += fmt::format("<rect x=\"{}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", left,
                       kMargin + static_cast<double>(j) * bar / steps, static_cast<double>(bar) / steps + 0.3,
                       colourAt(ramp, ramp.width - 1, j));
  for (int mark = 0; mark <= 4; ++mark)
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\">{:.3g}{}</text>\n", left + 20, kMargin + 4 + mark * bar / 4.0,
                       colours.top * std::pow(10, -colours.decades * mark / 4), mark == 0 ? " lx" : "");
  svg += fmt::format("<text x=\"{}\" y=\"{}\">{:.2f} x {:.2f} m, {} points</text>\n</svg>\n", kMargin,
                     height + kMargin + 18, glm::length(plan.grid.area.u) * plan.metresPerUnit,
                     glm::length(plan.grid.area.v) * plan.metresPerUnit, plan.lux.size());
  return svg;
}

void savePlan(const std::filesystem::path& file, const Plan& plan) {
  if (file.extension() == ".svg") return io::writeFile(file, planSvg(plan));
  saveImage(file, planImage(plan));
}

}  // namespace deltalux
