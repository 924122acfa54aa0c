// deltalux grid: a standard's measuring grid on an area, and what the standard asks of its illuminances.
#include <fmt/format.h>

#include <deltalux/error.hpp>
#include <deltalux/output.hpp>
#include <deltalux/plan.hpp>
#include <deltalux/points.hpp>
#include <deltalux/render.hpp>
#include <deltalux/sheet.hpp>

#include "commands.hpp"
#include "grid_place.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

struct GridOptions {
  SolutionSource source;
  RunOptions run;
  GridPlace place;
  std::string output, plan, kind, standard = "en12464";
  bool cylindrical = false;
};

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

/// What a kind of area asks for, against what there is.
void sayVerdict(const char* quantity, double reached, std::optional<double> required, const char* unit) {
  if (required)
    fmt::print("{}: {:.4g}{}, required at least {:g}{}: {}\n", quantity, reached, unit, *required, unit,
               reached >= *required ? "pass" : "FAIL");
}

void sayCylindrical(const MeasuringGrid& grid, const std::vector<double>& horizontal, const SolutionView& solution,
                    const ProbeSettings& settings, std::optional<double> required, Progress& progress) {
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
  if (!modelling.empty()) {
    const GridStatistics m = statisticsOf(modelling);
    fmt::print("modelling: {:.2f} ({:.2f} to {:.2f})\n", m.mean, m.least, m.most);
  }
  sayVerdict("Em, cylindrical", z.mean, required, " lx");
}

void runGrid(const GridOptions& options) {
  options.place.validate();
  Run run("grid", options.run);
  for (const std::string& file : {options.output, options.plan})
    if (!file.empty()) checkWritable(file);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution =
        options.source.load(run, options.run, progress, [&](const Scene& scene) { (void)options.place.grid(scene); });
    const Scene& scene = solution.scene();
    const MeasuringGrid grid = options.place.grid(scene);
    const ProbeSettings settings = meterSettings(solution, options.run.seed);
    const std::vector<ProbeResult> results = probe(solution, grid.points, settings, &progress);
    const std::vector<double> lux = luxOf(results, scene.luminousEfficacy);
    const GridStatistics s = statisticsOf(lux);
    if (!options.output.empty())
      writeProbeResults(options.output, tableOf(grid, scene), results, scene.luminousEfficacy);
    if (!options.plan.empty()) savePlan(options.plan, {grid, lux, options.place.name(), scene.metresPerUnit});
    if (!options.run.quiet) {
      fmt::print("{} points, {} x {}, {:.3g} x {:.3g} m apart\n", grid.points.size(), grid.columns, grid.rows,
                 glm::length(grid.area.u) * scene.metresPerUnit / grid.columns,
                 glm::length(grid.area.v) * scene.metresPerUnit / grid.rows);
      fmt::print("Em {:.4g} lx, Emin {:.4g} lx, Emax {:.4g} lx, U0 {:.3f}, Ud {:.3f}\n", s.mean, s.least, s.most,
                 s.uniformity(), s.diversity());
      const AreaRequirements required = en12464(options.kind).value_or(AreaRequirements{});
      sayVerdict("Em", s.mean, required.mean, " lx"), sayVerdict("U0", s.uniformity(), required.uniformity, "");
      if (options.cylindrical) sayCylindrical(grid, lux, solution, settings, required.cylindrical, progress);
    }
  }
  run.finish();
}

}  // namespace

void addGridCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("grid", "A standard's measuring grid, its illuminances and a plan of them");
  const auto options = std::make_shared<GridOptions>();
  options->source.add(*command);
  options->place.add(*command);
  command->add_option("--standard", options->standard, "Whose distances of points")
      ->check(CLI::IsMember({"en12464"}))
      ->capture_default_str();
  command->add_option("--height", options->place.settings.height, "Of the points above it [m]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--kind", options->kind, "Of area: Em, U0 and cylindrical against what EN 12464-1 asks for")
      ->check(CLI::IsMember(en12464Kinds()))
      ->type_name("KIND");
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
