#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "export/drawing.hpp"
#include "export/sheet/drawings.hpp"

namespace deltalux::exporting {

void drawPolar(Canvas& canvas, const Vec2& at, double side, const Photometry& p) {
  constexpr int kCurveSteps = 120;  // around a curve [shown]
  const Vec2 middle = at + Vec2(side / 2, side / 2);
  const double radius = side / 2 - 10, most = std::ranges::max(p.candela);
  if (!(most > 0)) return;
  const double step = roundBelow(most / 2), rim = step * std::ceil(most / step * (1 - 1e-9));
  const auto place = [&](double angle, double r) {
    return middle + r * Vec2(std::sin(angle * kPi / 180), std::cos(angle * kPi / 180));
  };
  const auto curve = [&](const auto& r) {
    std::vector<Vec2> points;
    for (int i = 0; i < kCurveSteps; ++i)
      points.push_back(place(360.0 * i / kCurveSteps - 180, r(360.0 * i / kCurveSteps - 180)));
    return points;
  };
  for (double circle = step; circle <= rim * 1.0001; circle += step) {
    canvas.path(curve([&](double) { return radius * circle / rim; }), true, {0.4, kPale, false});
    canvas.text(place(0, radius * circle / rim) + Vec2(2, -1), fmt::format("{:g}", circle), {5.5, kGrey});
  }
  for (int angle = 0; angle < 360; angle += 30) canvas.line(middle, place(angle, radius), {0.4, kPale, false});
  for (int angle = 0; angle <= 180; angle += 30)
    canvas.text(place(angle, radius + 7) + Vec2(0, 2), fmt::format("{}", angle),
                {5.5, kGrey, false, TextStyle::Align::Middle, false});
  canvas.path(curve([&](double angle) { return radius * candelaInPlane(p, 90, angle) / rim; }), true,
              {1.2, {0.1, 0.42, 0.66}, true});
  canvas.path(curve([&](double angle) { return radius * candelaInPlane(p, 0, angle) / rim; }), true,
              {1.2, {0.76, 0.27, 0.05}, false});
}

}  // namespace deltalux::exporting
