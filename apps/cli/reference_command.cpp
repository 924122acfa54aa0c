// deltalux reference: the unbiased answer, at points with standard errors or as a picture. Slow by design.
#include <fmt/format.h>

#include <cmath>
#include <deltalux/output.hpp>
#include <deltalux/points.hpp>
#include <deltalux/reference.hpp>

#include "commands.hpp"
#include "picture_options.hpp"
#include "scene_options.hpp"
#include "view_choice.hpp"

namespace deltalux::cli {

namespace {
struct ReferenceOptions {
  SceneOptions scene;
  RunOptions run;
  PictureOptions picture;
  std::string points, view, output;
  std::uint64_t samples = 0;
  double seconds = 0;
  bool diffuseOnly = false;

  ReferenceSettings settings() const {
    ReferenceSettings settings;
    if (samples > 0) settings.samples = samples;
    if (seconds > 0) settings.samples = 0;
    settings.seconds = seconds;
    settings.diffuseOnly = diffuseOnly;
    settings.seed = run.seed;
    return settings;
  }
};

/// Root mean square of the standard error of luminous values, relative to their mean.
double relativeError(const std::vector<ProbeResult>& results) {
  double squares = 0, sum = 0;
  for (const ProbeResult& result : results) {
    squares += std::pow(gray(result.standardError), 2);
    sum += gray(result.irradiance);
  }
  const double n = static_cast<double>(results.size());
  return sum > 0 ? std::sqrt(squares / n) / (sum / n) : 0.0;
}

void probePoints(const ReferenceOptions& options, const Scene& scene, const PointTable& table,
                 ReferenceIntegrator& integrator, Progress& progress, const Run& run) {
  const std::vector<ProbeResult> results = integrator.probe(pointsIn(scene, table), &progress);
  writeProbeResults(options.output, table, results, scene.luminousEfficacy);
  run.say(fmt::format("{}: {} points, standard error {:.2g} % of their mean", options.output, results.size(),
                      100 * relativeError(results)));
}

/// Irradiance of what each pixel's centre sees [W/m2]; -1 where that is nothing.
Image irradianceSeen(const Scene& scene, const View& view, glm::ivec2 size, ReferenceIntegrator& integrator,
                     Progress& progress) {
  const std::vector<std::optional<ProbePoint>> seen = visiblePoints(scene, view, size.x, size.y);
  std::vector<ProbePoint> points;
  for (const auto& point : seen)
    if (point) points.push_back(*point);
  const std::vector<ProbeResult> results = integrator.probe(points, &progress);
  Image image;
  image.width = size.x;
  image.height = size.y;
  image.luminousEfficacy = scene.luminousEfficacy;
  image.pixels.reserve(seen.size());
  auto result = results.begin();
  for (const auto& point : seen) image.pixels.push_back(point ? Rgb((result++)->irradiance) : Rgb(-1.0f));
  return image;
}

void renderView(const ReferenceOptions& options, const Scene& scene, const View& view, ReferenceIntegrator& integrator,
                Progress& progress, const Run& run) {
  const glm::ivec2 size = options.picture.resolution(view);
  if (options.picture.falseColor()) {
    options.picture.saveFalseColor(options.output, irradianceSeen(scene, view, size, integrator, progress));
  } else {
    Image image = integrator.render(view, size.x, size.y, &progress);
    image.view = viewOptions(view, scene.origin);
    options.picture.save(options.output, image, run);
  }
  run.say(fmt::format("{}: {} x {} pixels", options.output, size.x, size.y));
}

void validate(const ReferenceOptions& options) {
  if (options.points.empty() && options.view.empty()) throw CLI::RequiredError("--points or --view");
  if (!options.view.empty()) options.picture.validate(options.output);
}

void runReference(const ReferenceOptions& options) {
  validate(options);
  Run run("reference", options.run);
  checkWritable(options.output);
  const std::optional<PointTable> table =
      options.points.empty() ? std::nullopt : std::optional(readPoints(options.points));
  const ImportedScene imported = options.scene.load(run);
  const std::optional<View> view =
      options.view.empty() ? std::nullopt : std::optional(chooseView(imported.scene, options.view));
  ReferenceIntegrator integrator(imported.scene, options.settings());
  {
    ProgressPrinter progress(options.run.progressStyle());
    if (table)
      probePoints(options, imported.scene, *table, integrator, progress, run);
    else
      renderView(options, imported.scene, *view, integrator, progress, run);
  }
  const ReferenceStats stats = integrator.stats();
  run.report.reference = ReferenceReport{stats.paths, stats.rays, stats.seconds};
  run.finish();
}
}  // namespace

void addReferenceCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("reference", "The unbiased answer: irradiance at points, or a view; slow");
  const auto options = std::make_shared<ReferenceOptions>();
  options->scene.add(*command);
  CLI::Option* points = command->add_option("--points", options->points, "Points to measure: columns x,y,z,nx,ny,nz");
  points->type_name("P.csv");
  CLI::Option* view = command->add_option("--view", options->view, "A .vf file, or a view or camera of the scene");
  view->type_name("V")->excludes(points);
  command
      ->add_option("-o", options->output, "Where the result goes: a .csv for points, a .exr, .hdr or .png for a view")
      ->type_name("FILE")
      ->required();
  CLI::Option* samples = command->add_option("--samples", options->samples, "Paths per point or pixel (default: 1024)");
  samples->type_name("N")->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  command->add_option("--seconds", options->seconds, "Go on for this long instead")
      ->type_name("S")
      ->check(CLI::PositiveNumber)
      ->excludes(samples);
  command->add_flag("--diffuse-only", options->diffuseOnly,
                    "Drop specular lobes and mirrors; thin glass still passes light");
  options->picture.add(*command, view);
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runReference(*options); });
}

}  // namespace deltalux::cli
