#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/sheet.hpp>
#include <deltalux/solution_reader.hpp>

#include "base/check_interrupted.hpp"

namespace deltalux {

namespace {

constexpr double kBefore = 0.1;   // [m] what stands this near before a wall or below a ceiling hides it [defined]
constexpr double kLift = 0.02;    // where that is looked for from, over kBefore [rounding]
constexpr double kEyesApart = 1;  // [m] between places that UGR is asked for, at least [defined]

MeasuringGrid gridOfArea(const Scene& scene, const SheetArea& area, const GridSettings& settings) {
  if (const auto* surface = std::get_if<std::string>(&area.on)) return gridOn(scene, *surface, settings);
  if (const auto* rectangle = std::get_if<GridArea>(&area.on)) {
    GridArea placed = *rectangle;
    placed.corner -= scene.origin;
    return gridOf(placed, scene.metresPerUnit, settings);
  }
  std::vector<Vec3> corners = std::get<std::vector<Vec3>>(area.on);
  for (Vec3& p : corners) p -= scene.origin;
  return gridOn(*makePolygon(corners), scene.up, scene.metresPerUnit, settings);
}

/// Where people may look from, and how.
std::vector<Eye> eyesOf(const Scene& scene, const SheetArea& area, double spacing) {
  GridSettings settings = area.grid;
  settings.height = area.eyeHeight, settings.border = 0, settings.spacing = std::max(spacing, kEyesApart);
  const MeasuringGrid grid = gridOfArea(scene, area, settings);
  const Vec3 up = glm::normalize(scene.up), u = grid.area.u - glm::dot(grid.area.u, up) * up;
  const Vec3 along = glm::length(u) > 0 ? glm::normalize(u) : Frame(up).tangent;
  std::vector<Eye> eyes;
  for (const ProbePoint& p : grid.points)
    for (const Eye& eye : eyesAllRound(p.position, along, up, area.directions)) eyes.push_back(eye);
  return eyes;
}

Vec3 middleOf(const std::vector<ProbePoint>& points) {
  Vec3 sum(0.0);
  for (const ProbePoint& p : points) sum += p.position;
  return sum / static_cast<double>(points.size());
}

/// Whether something hides the surface there: a lamp below the ceiling, a cupboard before the wall.
bool hidden(const SolutionReader& reader, const ProbePoint& p, double metresPerUnit) {
  const double lift = kBefore * kLift / metresPerUnit;
  const auto met = reader.pick(p.position + lift * p.normal, p.normal);
  return met && met->distance * metresPerUnit < kBefore;
}

/// Points of the grids of some surfaces, on the sides that face a place.
std::vector<ProbePoint> pointsOn(const Scene& scene, const std::vector<std::string>& surfaces, const Vec3& from) {
  std::vector<ProbePoint> points;
  for (const std::string& surface : surfaces)
    for (ProbePoint p : gridOn(scene, surface).points) {
      if (glm::dot(from - p.position, p.normal) < 0) p.normal = -p.normal;
      points.push_back(p);
    }
  return points;
}

class Measurer {
 public:
  Measurer(const SolutionView& solution, const SheetRequest& request, const SheetSettings& settings, Progress* progress)
      : solution_(solution), request_(request), settings_(settings), progress_(progress) {
    error_ =
        std::max(solution.report().error.estimatedMedian.value_or(solution.settings().error), settings.probe.error);
  }

  MeasuredArea measure(const SheetArea& area) const {
    const Scene& scene = solution_.scene();
    MeasuredArea measured{area, gridOfArea(scene, area, area.grid), {}, {}, {}, 0, 0};
    noteCovered(measured);
    measured.lux = lux(measured.grid.points);
    const GridStatistics s = statisticsOf(measured.lux);
    const AreaRequirements& wanted = area.required;
    add(measured, "Em", "lx", s.mean, wanted.mean);
    add(measured, "U0 = Emin / Em", "", s.uniformity(), wanted.uniformity);
    add(measured, "Emin", "lx", s.least, {}), add(measured, "Emax", "lx", s.most, {});
    if (wanted.cylindrical) add(measured, "Em, cylindrical", "lx", cylindrical(area, measured), wanted.cylindrical);
    const Vec3 middle = middleOf(measured.grid.points);
    surroundings(measured, "walls", area.walls, wanted.walls, middle);
    surroundings(measured, "ceiling", area.ceiling, wanted.ceiling, middle);
    if (wanted.glare) rateGlare(measured);
    return measured;
  }

 private:
  /// `together`: of so many points in a row, only the mean is wanted.
  std::vector<double> lux(const std::vector<ProbePoint>& points, std::size_t together = 1) const {
    ProbeSettings probing = settings_.probe;
    probing.error = std::min(0.5, probing.error * std::sqrt(static_cast<double>(together)));
    checkInterrupted(progress_);
    if (progress_) progress_->report("measure", 0);
    std::vector<double> all;
    for (const ProbeResult& r : reader_.probe(points, probing))
      all.push_back(request_.maintenanceFactor * photometric(r.irradiance, solution_.scene().luminousEfficacy));
    if (progress_) progress_->report("measure", 1);
    return all;
  }
  void add(MeasuredArea& to, const std::string& quantity, const char* unit, double reached,
           std::optional<double> required) const {
    to.rows.push_back({quantity, unit, reached, required, false, error_ * reached});
  }
  /// Counts the points that something lies on, and leaves them out where that is asked for.
  void noteCovered(MeasuredArea& measured) const {
    MeasuringGrid free = measured.grid;
    free.points.clear(), free.cells.clear();
    for (std::size_t i = 0; i < measured.grid.points.size(); ++i)
      if (!hidden(reader_, measured.grid.points[i], solution_.scene().metresPerUnit))
        free.points.push_back(measured.grid.points[i]), free.cells.push_back(measured.grid.cells[i]);
    measured.covered = measured.grid.points.size() - free.points.size();
    if (measured.area.skipCovered && !free.points.empty()) measured.grid = std::move(free);
  }
  /// At the height of eyes, above the same points.
  double cylindrical(const SheetArea& area, const MeasuredArea& measured) const {
    const Scene& scene = solution_.scene();
    const Vec3 up = glm::normalize(scene.up);
    std::vector<ProbePoint> points;
    for (ProbePoint p : measured.grid.points) {
      p.position += (area.eyeHeight - area.grid.height) / scene.metresPerUnit * up;
      for (const ProbePoint& side : cylinderAt(p, up)) points.push_back(side);
    }
    return statisticsOf(lux(points, points.size() / measured.grid.points.size())).mean;
  }
  void surroundings(MeasuredArea& to, const char* what, const std::vector<std::string>& surfaces,
                    std::optional<double> required, const Vec3& middle) const {
    if (surfaces.empty()) return;
    std::vector<ProbePoint> points = pointsOn(solution_.scene(), surfaces, middle);
    std::vector<ProbePoint> seen = points;
    std::erase_if(seen, [&](const ProbePoint& p) { return hidden(reader_, p, solution_.scene().metresPerUnit); });
    const GridStatistics s = statisticsOf(lux(seen.empty() ? points : seen));
    add(to, fmt::format("Em, {}", what), "lx", s.mean, required);
    add(to, fmt::format("U0, {}", what), "", s.uniformity(), to.area.required.surroundingUniformity);
  }
  void rateGlare(MeasuredArea& to) const {
    const MeasuringGrid& g = to.grid;
    const double spacing = glm::length(g.area.u) / g.columns * solution_.scene().metresPerUnit;
    const std::vector<Eye> eyes = eyesOf(solution_.scene(), to.area, spacing);
    GlareSettings settings;
    settings.seed = settings_.probe.seed;
    const std::vector<UnifiedGlare> all = unifiedGlare(solution_, eyes, settings, progress_);
    to.worst = *std::ranges::max_element(all, {}, &UnifiedGlare::rating), to.glareEyes = all.size();
    // A relative error of Lb is this much of UGR.
    to.rows.push_back({"UGR, worst", "", to.worst->rating, to.area.required.glare, true, 8 * std::log10(1 + error_)});
  }

  const SolutionView& solution_;
  SolutionReader reader_{solution_};
  const SheetRequest& request_;
  const SheetSettings& settings_;
  Progress* progress_;
  double error_;  // relative, of irradiance
};

View viewOf(const Scene& scene, const SheetRequest& request) {
  for (const View& view : scene.views)
    if (view.name == request.view) return view;
  const std::filesystem::path beside = std::filesystem::path(request.file).parent_path() / request.view;
  std::error_code error;
  if (std::filesystem::is_regular_file(beside, error)) return inScene(scene, loadView(beside));
  throw InputError(request.file, 0, fmt::format("there is no view or view file '{}'", request.view),
                   "name a view of the scene, or a .vf file beside the request");
}

}  // namespace

bool MeasuredArea::passes() const { return std::ranges::all_of(rows, &SheetRow::passes); }

void validateSheetRequest(const SheetRequest& request, const Scene& scene) {
  for (const SheetArea& area : request.areas) {
    try {
      (void)gridOfArea(scene, area, area.grid);
      for (const auto* surfaces : {&area.walls, &area.ceiling}) (void)pointsOn(scene, *surfaces, Vec3(0));
    } catch (const InputError& error) {
      throw InputError(request.file, area.line, fmt::format("area '{}': {}", area.name, error.message()), error.hint());
    }
  }
  if (!request.view.empty()) (void)viewOf(scene, request);
}

Sheet measureSheet(const SolutionView& solution, const SheetRequest& request, const std::string& sceneName,
                   const SheetSettings& settings, Progress* progress) {
  const Scene& scene = solution.scene();
  validateSheetRequest(request, scene);
  Sheet sheet;
  sheet.request = request, sheet.scene = sceneName;
  sheet.metresPerUnit = scene.metresPerUnit, sheet.luminousEfficacy = scene.luminousEfficacy;
  sheet.error = solution.report().error, sheet.settings = solution.settings();
  const Measurer measurer(solution, request, settings, progress);
  for (const SheetArea& area : request.areas) sheet.areas.push_back(measurer.measure(area));
  sheet.luminaires = luminaireTypes(scene, request.luminaires);
  if (!request.view.empty()) {
    const View view = viewOf(scene, request);
    const glm::ivec2 size = fitResolution(view, settings.width, settings.width);
    RenderSettings rendering;
    rendering.width = size.x, rendering.height = size.y;
    rendering.samplesPerPixel = settings.samplesPerPixel, rendering.seed = settings.probe.seed;
    sheet.rendering = render(solution, view, rendering, progress);
  }
  return sheet;
}

}  // namespace deltalux
