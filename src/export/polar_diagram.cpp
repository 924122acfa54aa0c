#include <deltalux/polar_diagram.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "export/drawing.hpp"
#include "io/atomic_file.hpp"

namespace deltalux {

namespace {

constexpr int kSide = 480, kTop = 56;  // of the picture; of what is above the diagram [px] [layout]
constexpr double kRadius = 200;        // of the outermost circle [px] [layout]
constexpr int kCurve = 360;            // points of a plane [layout]
constexpr double kSearch = 0.25;       // between directions that are looked at [degrees] [limit]
constexpr double kStepUp = 1e-6;       // from light to darkness [degrees] [rounding]

double greatest(const Photometry& p, double plane) {
  double most = 0;
  for (double a = -180; a <= 180; a += kSearch) most = std::max(most, exporting::candelaInPlane(p, plane, a));
  return most;
}

double halfPeakAngle(const Photometry& p, double plane) {
  const double half = 0.5 * greatest(p, plane);
  if (!(half > 0)) return 0;
  const auto reach = [&](double sign) {
    double last = 0;
    for (double a = 0; a <= 180; a += kSearch)
      if (exporting::candelaInPlane(p, plane, sign * a) >= half) last = a;
    return last;
  };
  return reach(1) + reach(-1);
}

/// The same, dark above the horizontal plane.
Photometry belowHorizon(const Photometry& p) {
  Photometry below;
  below.horizontals = p.horizontals;
  for (const double v : p.verticals)
    if (v < 90) below.verticals.push_back(v);
  for (const double v : {90.0, 90 + kStepUp, 180.0}) below.verticals.push_back(v);
  for (const double h : below.horizontals)
    for (const double v : below.verticals) below.candela.push_back(v > 90 ? 0 : candela(p, v, h));
  return below;
}

}  // namespace

PhotometrySummary summarize(const Photometry& p) {
  PhotometrySummary s;
  s.flux = luminousFlux(p);
  s.downwards = s.flux > 0 ? std::min(1.0, luminousFlux(belowHorizon(p)) / s.flux) : 0;
  for (std::size_t h = 0; h < p.horizontals.size(); ++h)
    for (std::size_t v = 0; v < p.verticals.size(); ++v)
      if (const double I = p.candela[h * p.verticals.size() + v]; I > s.peak)
        s.peak = I, s.peakVertical = p.verticals[v], s.peakHorizontal = p.horizontals[h];
  s.halfPeak = {halfPeakAngle(p, 0), halfPeakAngle(p, 90)};
  return s;
}

std::string polarDiagram(const Photometry& p, const std::string& title) {
  const PhotometrySummary s = summarize(p);
  const double x0 = 0.5 * kSide, y0 = kTop + 0.5 * kSide;
  const double step = s.peak > 0 ? exporting::roundBelow(s.peak / 3) : 1;
  const double rim = s.peak > 0 ? step * std::ceil(s.peak / step) : 1;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"20\" text-anchor=\"middle\" font-size=\"14\">{3}</text>\n"
      "<text x=\"{2}\" y=\"38\" text-anchor=\"middle\">{4:.0f} lm, at most {5:.4g} cd; C0-C180 solid, C90-C270 "
      "dashed</text>\n",
      kSide, kSide + kTop + 8, x0, exporting::inXml(title), s.flux, s.peak);
  svg += "<g fill=\"none\" stroke=\"#ccc\">\n";
  for (double circle = step; circle <= rim * 1.0001; circle += step)
    svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\"/>\n", x0, y0, kRadius * circle / rim);
  for (int angle = 0; angle < 360; angle += 30) {
    const double a = angle * kPi / 180;
    svg += fmt::format("<path d=\"M{} {}L{:.1f} {:.1f}\"/>\n", x0, y0, x0 + kRadius * std::sin(a),
                       y0 + kRadius * std::cos(a));
  }
  svg += "</g>\n<g fill=\"#555\" font-size=\"10\">\n";
  for (double circle = step; circle <= rim * 1.0001; circle += step)
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\">{:g}</text>\n", x0 + 3, y0 + kRadius * circle / rim - 3, circle);
  for (int angle = 0; angle <= 180; angle += 30)
    for (const int side : {1, -1}) {
      if (side < 0 && angle % 180 == 0) continue;
      const double a = side * angle * kPi / 180, r = kRadius + 14;
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}&#176;</text>\n",
                         x0 + r * std::sin(a), y0 + r * std::cos(a) + 4, angle);
    }
  svg += "</g>\n";
  for (const double plane : {90.0, 0.0}) {
    svg += fmt::format("<polygon fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{} points=\"",
                       plane > 0 ? "#1b6ca8" : "#c1440e", plane > 0 ? " stroke-dasharray=\"6 4\"" : "");
    for (int i = 0; i < kCurve; ++i) {
      const double angle = 360.0 * i / kCurve - 180, a = angle * kPi / 180,
                   r = kRadius * exporting::candelaInPlane(p, plane, angle) / rim;
      svg += fmt::format("{:.1f},{:.1f} ", x0 + r * std::sin(a), y0 + r * std::cos(a));
    }
    svg += "\"/>\n";
  }
  return svg + "</svg>\n";
}

void savePolarDiagram(const std::filesystem::path& file, const Photometry& p, const std::string& title) {
  io::writeFile(file, polarDiagram(p, title));
}

}  // namespace deltalux
