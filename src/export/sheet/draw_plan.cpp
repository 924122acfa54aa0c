#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "export/plan_field.hpp"
#include "export/sheet/drawings.hpp"

namespace deltalux::exporting {

namespace {

constexpr double kLegend = 52;        // for the scale at the right [pt] [shown]
constexpr int kTint = 8, kMarks = 4;  // squares across a cell; marks of the scale [shown]
constexpr double kLeastText = 3.5;    // smaller values are not written [pt] [shown]
constexpr double kLabelsApart = 24;   // of lines: farther is no better [pt] [shown]
constexpr double kEyeMark = 5;        // [pt] [shown]

/// A grid's cells on the page.
struct PlanFrame {
  Vec2 at, size;  // of the grid
  int columns, rows;

  Vec2 place(const Vec2& cells) const {
    return {at.x + cells.x / columns * size.x, at.y + size.y - cells.y / rows * size.y};
  }
};

void drawColours(Canvas& canvas, const PlanFrame& frame, const PlanField& field, const FalseColorSettings& colours) {
  const int across = field.columns() * kTint, down = field.rows() * kTint;
  const auto lux = [&](int i, int j) { return field.at((i + 0.5) / kTint, (down - j - 0.5) / kTint); };
  const Image image = imageOfLux(across, down, lux);
  const DisplayImage legend = falseColor(image, colours);
  DisplayImage shown{across, down, {}};
  const int left = legend.width - across;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i)
      shown.pixels.push_back(image.at(i, j).r < 0 ? std::array<std::uint8_t, 3>{255, 255, 255}
                                                  : legend.at(left + i, j));
  canvas.image(frame.at, frame.size, shown);
}

/// The middle of the part that is farthest from all labels so far.
Vec2 labelPlace(const PlanFrame& frame, const std::vector<Segment>& line, const std::vector<Vec2>& others) {
  Vec2 best = frame.place(line[line.size() / 2].a);
  double most = -1;
  for (const Segment& part : line) {
    const Vec2 at = frame.place(0.5 * (part.a + part.b));
    double free = kLabelsApart;
    for (const Vec2& other : others) free = std::min(free, glm::length((at - other) / Vec2(2, 1)));
    if (free > most) most = free, best = at;
  }
  return best;
}

void drawLines(Canvas& canvas, const PlanFrame& frame, const PlanField& field, const GridStatistics& s) {
  std::vector<Vec2> places;
  std::vector<std::string> labels;
  for (const double level : levelsOf(s)) {
    const std::vector<Segment> line = lineAt(field, level);
    for (const Segment& part : line) canvas.line(frame.place(part.a), frame.place(part.b), {1.0, kBlack, false});
    if (line.empty()) continue;
    places.push_back(labelPlace(frame, line, places)), labels.push_back(fmt::format("{:.4g}", level));
  }
  for (std::size_t i = 0; i < labels.size(); ++i)
    canvas.text(places[i] + Vec2(0, 3), labels[i], {7.5, kBlack, true, TextStyle::Align::Middle, true});
}

void drawValues(Canvas& canvas, const PlanFrame& frame, const PlanField& field) {
  const double size = std::min(6.5, 0.38 * frame.size.x / field.columns());
  if (size < kLeastText) return;
  for (int r = 0; r < field.rows(); ++r)
    for (int c = 0; c < field.columns(); ++c)
      if (field.cell(c, r) >= 0)
        canvas.text(frame.place({c + 0.5, r + 0.5}) + Vec2(0, size / 3), fmt::format("{:.0f}", field.cell(c, r)),
                    {size, kBlack, false, TextStyle::Align::Middle, true});
}

void drawScale(Canvas& canvas, const Vec2& at, double height, const FalseColorSettings& colours) {
  constexpr int kScaleSteps = 48;  // [shown]
  const auto lux = [&](int, int j) { return colours.top * std::pow(10, -colours.decades * (j + 0.5) / kScaleSteps); };
  const DisplayImage legend = falseColor(imageOfLux(1, kScaleSteps, lux), colours);
  for (int j = 0; j < kScaleSteps; ++j) {
    const auto& c = legend.at(legend.width - 1, j);
    canvas.fill({at.x, at.y + j * height / kScaleSteps}, {10, height / kScaleSteps + 0.3},
                {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0});
  }
  const auto value = [&](int mark) { return colours.top * std::pow(10, -colours.decades * mark / kMarks); };
  for (int mark = 0; mark <= kMarks; ++mark)
    canvas.text({at.x + 13, at.y + 3 + mark * height / kMarks},
                fmt::format("{:.{}f}{}", value(mark), value(mark) < 10 ? 1 : 0, mark == 0 ? " lx" : ""),
                {7, kGrey, false, TextStyle::Align::Left, false});
}

void drawEye(Canvas& canvas, const PlanFrame& frame, const GridArea& area, const Eye& eye) {
  const auto inCells = [&](const Vec3& v) {
    return Vec2(glm::dot(v, area.u) / glm::dot(area.u, area.u) * frame.columns,
                glm::dot(v, area.v) / glm::dot(area.v, area.v) * frame.rows);
  };
  const Vec2 at = frame.place(inCells(eye.position - area.corner));
  const Vec2 ahead = frame.place(inCells(eye.position - area.corner + eye.direction)) - at;
  if (!(glm::length(ahead) > 0)) return;
  const Vec2 d = kEyeMark * glm::normalize(ahead), n(-d.y, d.x);
  const Vec2 triangle[] = {at + 1.6 * d, at - d + 0.8 * n, at - d - 0.8 * n};
  canvas.path(triangle, true, {3, kWhite, false});
  canvas.path(triangle, true, {1.4, kBad, false});
}

}  // namespace

double drawPlan(Canvas& canvas, const Vec2& at, const Vec2& box, const Plan& plan, const Eye* eye) {
  const PlanField field(plan.grid, plan.lux);
  const double w = glm::length(plan.grid.area.u), h = glm::length(plan.grid.area.v);
  const double scale = std::min((box.x - kLegend) / w, (box.y - 14) / h);
  const PlanFrame frame{at, {w * scale, h * scale}, field.columns(), field.rows()};
  const GridStatistics s = statisticsOf(plan.lux);
  const FalseColorSettings colours = coloursOf(s, kFewDecades);
  drawColours(canvas, frame, field, colours);
  drawValues(canvas, frame, field);
  drawLines(canvas, frame, field, s);
  const Vec2 rim[] = {at, at + Vec2(frame.size.x, 0), at + frame.size, at + Vec2(0, frame.size.y)};
  canvas.path(rim, true, {0.8, kGrey, false});
  if (eye) drawEye(canvas, frame, plan.grid.area, *eye);
  drawScale(canvas, {at.x + frame.size.x + 10, at.y}, std::min(frame.size.y, 150.0), colours);
  canvas.text({at.x, at.y + frame.size.y + 11},
              fmt::format("{:.2f} x {:.2f} m, {} x {} cells, {} points", w * plan.metresPerUnit, h * plan.metresPerUnit,
                          field.columns(), field.rows(), plan.lux.size()),
              {7.5, kGrey, false, TextStyle::Align::Left, false});
  return frame.size.y + 14;
}

}  // namespace deltalux::exporting
