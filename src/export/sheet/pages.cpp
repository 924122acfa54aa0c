// How a sheet is laid out: the verdicts and the rendering first, then luminaires and settings, then a page an area.
#include "export/sheet/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "export/sheet/drawings.hpp"

namespace deltalux::exporting {

namespace {

constexpr double kWidth = kPageWidth - 2 * kPageMargin;  // of what is printed on [layout]
constexpr double kRow = 15, kFoot = 30;                  // of a table; kept free below [pt] [shown]
using Align = TextStyle::Align;

std::string shown(double value, const std::string& unit) {
  if (!std::isfinite(value)) return value > 0 ? "unbounded" : "none seen";
  if (unit == "lx") return fmt::format("{:.{}f} lx", value, value < 100 ? 1 : 0);
  return fmt::format("{:.{}f}", value, std::abs(value) < 1.5 ? 2 : 1);
}

struct Verdict {
  std::string text;
  Ink ink;
};

Verdict verdictOf(const SheetRow& row) {
  if (!row.required) return {"", kGrey};
  if (!row.passes()) return {row.close() ? "FAIL (within error)" : "FAIL", kBad};
  return {row.close() ? "pass (within error)" : "pass", row.close() ? kAmber : kGood};
}

std::string requiredOf(const SheetRow& row) {
  if (!row.required) return "";
  return fmt::format("{} {}", row.atMost ? "\u2264" : "\u2265", shown(*row.required, row.unit));
}

class Layout {
 public:
  Layout(Canvas& canvas, const Sheet& sheet) : canvas_(canvas), sheet_(sheet) {}

  void draw() {
    first();
    luminaires();
    for (const MeasuredArea& area : sheet_.areas) areaPage(area);
  }

 private:
  void page(const std::string& heading) {
    canvas_.beginPage();
    ++page_;
    y_ = kPageMargin + 12;
    text(0, heading, {15, kBlack, true});
    const std::string& project = sheet_.request.project;
    canvas_.text({kPageWidth - kPageMargin, y_}, project.empty() ? sheet_.request.title : project,
                 {8, kGrey, false, Align::Right});
    y_ += 7;
    canvas_.line({kPageMargin, y_}, {kPageWidth - kPageMargin, y_}, {1.2, kBlack});
    y_ += 18;
    const double foot = kPageHeight - kPageMargin + 14;
    canvas_.text({kPageMargin, foot}, "deltalux " DELTALUX_VERSION, {7, kGrey});
    canvas_.text({kPageWidth / 2, foot}, sheet_.scene, {7, kGrey, false, Align::Middle});
    canvas_.text({kPageWidth - kPageMargin, foot}, fmt::format("page {}", page_), {7, kGrey, false, Align::Right});
  }
  /// A new page of that heading where there is no place left for so much.
  void need(double height, const std::string& heading) {
    if (y_ + height > kPageHeight - kPageMargin - kFoot + 20) page(heading);
  }
  void text(double x, const std::string& what, const TextStyle& style = {}) {
    canvas_.text({kPageMargin + x, y_}, what, style);
  }
  void heading(const std::string& what) {
    text(0, what, {10.5, kBlack, true});
    y_ += 15;
  }
  void rule() { canvas_.line({kPageMargin, y_ + 4}, {kPageWidth - kPageMargin, y_ + 4}, {0.4, kPale}); }
  void fact(const std::string& name, const std::string& value) {
    text(0, name, {8.5, kGrey});
    text(130, value, {8.5});
    y_ += 13;
  }

  void first() {
    page(sheet_.request.title);
    for (const auto& [name, value] : {std::pair{"Project", sheet_.request.project},
                                      {"By", sheet_.request.author},
                                      {"Date", sheet_.request.date},
                                      {"Scene", sheet_.scene}})
      if (!value.empty()) fact(name, value);
    y_ += 8;
    if (sheet_.rendering) rendering(*sheet_.rendering);
    heading("What was asked for, and what there is");
    tableHead({"Area", "Quantity"});
    for (const MeasuredArea& area : sheet_.areas) {
      bool named = false;
      for (const SheetRow& row : area.rows) {
        if (!row.required) continue;
        need(kRow, "What was asked for, and what there is");
        if (!named) text(0, area.area.name, {8.5, kBlack, true});
        named = true;
        tableRow(row);
      }
      if (!named) {
        text(0, area.area.name, {8.5, kBlack, true});
        text(150, "nothing was asked for", {8.5, kGrey});
        rule();
        y_ += kRow;
      }
    }
    y_ += 6;
    const auto failed = std::ranges::count_if(sheet_.areas, [](const MeasuredArea& a) { return !a.passes(); });
    text(0,
         failed == 0 ? "All requirements are met."
                     : fmt::format("{} of {} areas do not meet what was asked for.", failed, sheet_.areas.size()),
         {10, failed == 0 ? kGood : kBad, true});
  }
  void tableHead(const std::vector<std::string>& names) {
    text(0, names[0], {7.5, kGrey});
    text(quantityAt_, names[1], {7.5, kGrey});
    number(330, "required", {7.5, kGrey}), number(405, "reached", {7.5, kGrey});
    text(420, "verdict", {7.5, kGrey});
    rule();
    y_ += kRow;
  }
  void number(double right, const std::string& what, TextStyle style) {
    style.align = Align::Right;
    text(right, what, style);
  }
  void tableRow(const SheetRow& row) {
    const Verdict verdict = verdictOf(row);
    text(quantityAt_, row.quantity, {8.5});
    number(330, requiredOf(row), {8.5}), number(405, shown(row.reached, row.unit), {8.5, kBlack, true});
    text(420, verdict.text, {8.5, verdict.ink, true});
    rule();
    y_ += kRow;
  }
  void rendering(const Image& image) {
    const double scale = std::min(kWidth / image.width, 300.0 / image.height);
    const Vec2 size(image.width * scale, image.height * scale);
    canvas_.image({kPageMargin, y_}, size, toneMap(image, {ToneOperator::Reinhard, automaticEv(image)}));
    y_ += size.y + 24;
  }

  void luminaires() {
    page("Luminaires and settings");
    double flux = 0, watts = 0;
    int count = 0, known = 0;
    for (const LuminaireType& type : sheet_.luminaires) {
      need(150, "Luminaires and settings");
      luminaire(type);
      count += type.count, flux += type.count * type.flux;
      if (type.watts) watts += type.count * *type.watts, known += type.count;
    }
    y_ += 4;
    std::string sum = count > 0 ? fmt::format("{} luminaires, {:.0f} lm", count, flux)
                                : "No luminaires: what light there is comes from sun and sky.";
    if (known == count && count > 0) sum += fmt::format(", {:.0f} W, {:.0f} lm/W", watts, watts > 0 ? flux / watts : 0);
    if (known < count && known > 0) sum += fmt::format("; {:.0f} W of those {} whose power is known", watts, known);
    text(0, sum, {9, kBlack, true});
    y_ += 24;
    need(190, "Luminaires and settings");
    heading("How this was computed");
    const SheetRequest& r = sheet_.request;
    fact("Maintenance factor", fmt::format("{:g} (in all illuminances)", r.maintenanceFactor));
    fact("Grid", "EN 12464-1: p = 0.2 \u00b7 5^(log10 d) m, points in the middles of cells");
    fact("Error asked for", fmt::format("{:g} % of irradiance", 100 * sheet_.error.asked));
    if (sheet_.error.estimatedMedian)
      fact("Error estimated",
           fmt::format("{:.2g} % in the median, {:.2g} % in the 95th percentile, by area",
                       100 * *sheet_.error.estimatedMedian, 100 * sheet_.error.estimatedP95.value_or(0)));
    fact("Method", sheet_.settings.method == SolveMethod::Lines ? "lines (global illumination)" : "links [GD01]");
    fact("Seed", fmt::format("{}", sheet_.settings.seed));
    fact("Luminous efficacy", fmt::format("{:g} lm/W (radiance to luminance)", sheet_.luminousEfficacy));
    fact("UGR", "CIE 117, luminaires by their photometry, small sources by CIE 147");
    fact("Version", "deltalux " DELTALUX_VERSION);
    y_ += 6;
    text(0, "\u201cwithin error\u201d: nearer to what is required than the estimated error of the solution.",
         {7.5, kGrey});
  }
  void luminaire(const LuminaireType& type) {
    const double top = y_ - 6;
    text(0, fmt::format("{} \u00d7 {}", type.count, type.name), {10, kBlack, true});
    y_ += 15;
    fact("Luminous flux", fmt::format("{:.0f} lm", type.flux));
    if (type.watts)
      fact("Power", fmt::format("{:g} W, {:.0f} lm/W", *type.watts, *type.watts > 0 ? type.flux / *type.watts : 0));
    if (type.photometry) {
      const Vec3 o = type.photometry->opening;
      const char* round = o.x < 0 || o.y < 0 ? "round, " : "";
      if (glm::length(o) > 0)
        fact("Luminous area", fmt::format("{}{:.2f} x {:.2f} m", round, std::abs(o.y), std::abs(o.x)));
      fact("Peak intensity", fmt::format("{:.0f} cd", std::ranges::max(type.photometry->candela)));
      drawPolar(canvas_, {kPageWidth - kPageMargin - 146, top}, 140, *type.photometry);
      text(0, "solid C0\u2013C180, dashed C90\u2013C270 [cd]", {7, kGrey});
      y_ = top + 154;
    } else {
      fact("Distribution", "of its own surface: not measured");
      y_ += 12;
    }
    canvas_.line({kPageMargin, y_ - 10}, {kPageWidth - kPageMargin, y_ - 10}, {0.4, kPale});
    y_ += 6;
  }

  void areaPage(const MeasuredArea& area) {
    page(area.area.name);
    std::string what = area.area.kind.empty() ? "" : fmt::format("EN 12464-1, {}; ", area.area.kind);
    what += fmt::format("measured {:g} m above ", area.area.grid.height);
    if (const auto* surface = std::get_if<std::string>(&area.area.on))
      what += "the surface " + *surface;
    else
      what += std::holds_alternative<GridArea>(area.area.on) ? "a rectangle" : "a polygon";
    text(0, what, {8.5, kGrey});
    y_ += 14;
    const Plan plan{area.grid, area.lux, area.area.name, sheet_.metresPerUnit};
    const Eye* eye = area.worst && std::isfinite(area.worst->rating) ? &area.worst->eye : nullptr;
    y_ += drawPlan(canvas_, {kPageMargin, y_}, {kWidth, 370}, plan, eye) + 12;
    if (eye) {
      text(0,
           fmt::format("Triangle: where UGR is worst, {:.1f}, of {} places and lines of sight with eyes {:g} m high; "
                       "{} luminaires seen, background {:.3g} cd/m\u00b2.",
                       area.worst->rating, area.glareEyes, area.area.eyeHeight, area.worst->luminaires.size(),
                       area.worst->background),
           {7, kGrey});
      y_ += 14;
    }
    if (area.covered > 0) {
      text(0,
           fmt::format("{} points have something less than 0.1 m before them{}.", area.covered,
                       area.area.skipCovered ? ", and are left out" : ""),
           {7, kGrey});
      y_ += 14;
    }
    y_ += 6;
    quantityAt_ = 0;
    tableHead({"", "Quantity"});
    for (const SheetRow& row : area.rows) {
      need(kRow, area.area.name);
      tableRow(row);
    }
  }

  Canvas& canvas_;
  const Sheet& sheet_;
  double y_ = 0, quantityAt_ = 150;  // on this page; of tables
  int page_ = 0;
};

}  // namespace

void drawSheet(Canvas& canvas, const Sheet& sheet) { Layout(canvas, sheet).draw(); }

}  // namespace deltalux::exporting
