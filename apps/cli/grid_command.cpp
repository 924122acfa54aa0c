// deltalux grid: a standard's measuring grid on an area, and what the standard asks of its illuminances.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>
#include <deltalux/plan.hpp>
#include <deltalux/points.hpp>
#include <deltalux/render.hpp>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

constexpr double kRight = 1e-4;  // cosine between sides at right angles at most

struct GridOptions {
  SolutionSource source;
  RunOptions run;
  std::string area, surface, output, plan, standard = "en12464";
  GridSettings grid;
  bool cylindrical = false;
};

/// In the coordinates of the scene's files.
GridArea areaIn(const std::string& text) {
  std::array<double, 9> n{};
  char rest = 0;
  const int count = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &n[3],
                                &n[4], &n[5], &n[6], &n[7], &n[8], &rest);
  const GridArea area{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
  const double u = glm::length(area.u), v = glm::length(area.v);
  if (count != 9 || !std::isfinite(u + v + glm::length(area.corner)))
    throw CLI::ValidationError("--area " + text + ": not X,Y,Z,UX,UY,UZ,VX,VY,VZ (a corner and two sides)");
  if (!(u > 0 && v > 0) || std::abs(glm::dot(area.u, area.v)) > kRight * u * v)
    throw CLI::ValidationError("--area " + text + ": its sides are not at right angles");
  return area;
}

MeasuringGrid gridIn(const Scene& scene, const GridOptions& options) {
  if (!options.surface.empty()) return gridOn(scene, options.surface, options.grid);
  GridArea area = areaIn(options.area);
  area.corner -= scene.origin;
  return gridOf(area, scene.metresPerUnit, options.grid);
}

/// The points in the coordinates of the scene's files, as a table to write.
PointTable tableOf(const MeasuringGrid& grid, const Scene& scene) {
  PointTable table;
  table.columns = {"x", "y", "z", "nx", "ny", "nz", "column", "row"};
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Vec3 p = grid.points[i].position + scene.origin, n = grid.points[i].normal;
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::vector<std::string> row;
    for (const double value : {p.x, p.y, p.z, n.x, n.y, n.z}) row.push_back(fmt::format("{:.10g}", value));
    row.push_back(fmt::format("{}", grid.cells[i] % columns)),
        row.push_back(fmt::format("{}", grid.cells[i] / columns));
    table.rows.push_back(std::move(row));
    table.points.push_back({p, n});
  }
  return table;
}

void sayCylindrical(const MeasuringGrid& grid, const std::vector<double>& horizontal, const SolutionView& solution,
                    const ProbeSettings& settings, Progress& progress) {
  std::vector<ProbePoint> points;
  for (const ProbePoint& p : grid.points)
    for (const ProbePoint& side : cylinderAt(p, solution.scene().up)) points.push_back(side);
  const std::vector<double> sides =
      luxOf(probe(solution, points, settings, &progress), solution.scene().luminousEfficacy);
  const std::size_t each = points.size() / grid.points.size();
  std::vector<double> cylindrical, modelling;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    cylindrical.push_back(statisticsOf(std::span(sides).subspan(i * each, each)).mean);
    if (horizontal[i] > 0) modelling.push_back(cylindrical.back() / horizontal[i]);
  }
  const GridStatistics z = statisticsOf(cylindrical);
  fmt::print("cylindrical: Em {:.4g} lx, U0 {:.2f}\n", z.mean, z.uniformity());
  if (modelling.empty()) return;
  const GridStatistics m = statisticsOf(modelling);
  fmt::print("modelling: {:.2f} ({:.2f} to {:.2f})\n", m.mean, m.least, m.most);
}

void runGrid(const GridOptions& options) {
  if (options.area.empty() == options.surface.empty())
    throw CLI::ValidationError("say where: either --area or --surface");
  if (!options.area.empty()) areaIn(options.area);
  Run run("grid", options.run);
  for (const std::string& file : {options.output, options.plan})
    if (!file.empty()) checkWritable(file);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution =
        options.source.load(run, options.run, progress, [&](const Scene& scene) { (void)gridIn(scene, options); });
    const Scene& scene = solution.scene();
    const MeasuringGrid grid = gridIn(scene, options);
    const ProbeSettings settings = meterSettings(solution, options.run.seed);
    const std::vector<ProbeResult> results = probe(solution, grid.points, settings, &progress);
    const std::vector<double> lux = luxOf(results, scene.luminousEfficacy);
    const GridStatistics s = statisticsOf(lux);
    if (!options.output.empty())
      writeProbeResults(options.output, tableOf(grid, scene), results, scene.luminousEfficacy);
    if (!options.plan.empty())
      savePlan(options.plan, {grid, lux, options.surface.empty() ? "area" : options.surface, scene.metresPerUnit});
    if (!options.run.quiet) {
      fmt::print("{} points, {} x {}, {:.3g} x {:.3g} m apart\n", grid.points.size(), grid.columns, grid.rows,
                 glm::length(grid.area.u) * scene.metresPerUnit / grid.columns,
                 glm::length(grid.area.v) * scene.metresPerUnit / grid.rows);
      fmt::print("Em {:.4g} lx, Emin {:.4g} lx, Emax {:.4g} lx, U0 {:.3f}, Ud {:.3f}\n", s.mean, s.least, s.most,
                 s.uniformity(), s.diversity());
      if (options.cylindrical) sayCylindrical(grid, lux, solution, settings, progress);
    }
  }
  run.finish();
}

}  // namespace

void addGridCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("grid", "A standard's measuring grid, its illuminances and a plan of them");
  const auto options = std::make_shared<GridOptions>();
  options->source.add(*command);
  command->add_option("--surface", options->surface, "On that object's largest level polygon, or its largest")
      ->type_name("NAME");
  command
      ->add_option("--area", options->area,
                   "On a rectangle: a corner, and two sides at right angles; measured where U x V points")
      ->type_name("X,Y,Z,UX,UY,UZ,VX,VY,VZ");
  command->add_option("--standard", options->standard, "Whose distances of points")
      ->check(CLI::IsMember({"en12464"}))
      ->capture_default_str();
  command->add_option("--spacing", options->grid.spacing, "Distance of points at most, in place of the standard's [m]")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  command
      ->add_option("--border", options->grid.border,
                   "Left out along the rim, but no more than 15 % of the shorter side [m]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--height", options->grid.height, "Of the points above it [m]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("M")
      ->capture_default_str();
  command->add_flag("--cylindrical", options->cylindrical, "Cylindrical illuminance and modelling, too");
  command->add_option("-o", options->output, "Where the points with E_r, E_g, E_b, lux and se_r, se_g, se_b go")
      ->type_name("OUT.csv");
  command->add_option("--plan", options->plan, "Where a plan goes: false colours and lines of equal illuminance")
      ->check([](const std::string& file) {
        return file.ends_with(".svg") || file.ends_with(".png") ? std::string() : "a plan is an .svg or a .png";
      })
      ->type_name("PLAN.svg|PLAN.png");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runGrid(*options); });
}

}  // namespace deltalux::cli
