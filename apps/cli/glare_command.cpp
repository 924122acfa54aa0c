// deltalux glare: UGR and DGP from an eye, or the worst UGR over a grid of places and directions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deltalux/error.hpp>
#include <deltalux/glare.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/output.hpp>
#include <filesystem>

#include "commands.hpp"
#include "grid_place.hpp"
#include "solution_source.hpp"
#include "view_choice.hpp"

namespace deltalux::cli {

namespace {

constexpr std::size_t kListed = 12;  // sources and luminaires that are printed

struct GlareOptions {
  SolutionSource source;
  RunOptions run;
  GridPlace place;
  GlareSettings glare;
  std::string view, eye, towards, task, output, json;
  double eyeHeight = 1.2;
  int directions = 8;
};

Vec3 tripleIn(const char* option, const std::string& text) {
  Vec3 p(0.0);
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &p.x, &p.y, &p.z, &rest) != 3 || !std::isfinite(p.x + p.y + p.z))
    throw CLI::ValidationError(fmt::format("{} {}: not X,Y,Z", option, text));
  return p;
}

/// Where the marks of a picture go: into it, or beside one that holds light.
std::filesystem::path marksOf(const std::string& picture) {
  std::filesystem::path file(picture);
  return imageFormatOf(file) == ImageFormat::Png ? file : file.replace_extension(".marks.png");
}

void validate(const GlareOptions& options) {
  const int ways = (options.view.empty() ? 0 : 1) + (options.eye.empty() ? 0 : 1) + (options.place.given() ? 1 : 0);
  if (ways != 1) throw CLI::ValidationError("say where from: one of --view, --eye with --towards, --area, --surface");
  if (options.place.given()) options.place.validate();
  if (!options.eye.empty()) {
    const Vec3 eye = tripleIn("--eye", options.eye), towards = tripleIn("--towards", options.towards);
    if (eye == towards) throw CLI::ValidationError("--towards " + options.towards + ": that is where the eye is");
  }
  if (!options.task.empty()) tripleIn("--task", options.task);
  if (options.place.given() && !(options.output.empty() && options.task.empty()))
    throw CLI::ValidationError("-o and --task are about one eye: --view, or --eye with --towards");
  if (options.output.empty()) return;
  if (!imageFormatOf(options.output))
    throw CLI::ValidationError(fmt::format("-o {}: a picture's name ends in .exr, .hdr or .png", options.output));
  checkWritable(options.output);
  checkWritable(marksOf(options.output));
}

Eye eyeIn(const Scene& scene, const GlareOptions& options) {
  if (!options.view.empty()) {
    const View view = chooseView(scene, options.view);
    return {view.position, view.direction, view.up};
  }
  const Vec3 eye = tripleIn("--eye", options.eye), towards = tripleIn("--towards", options.towards);
  return {eye - scene.origin, towards - eye, scene.up};
}

/// At the points of a grid, looking level all round.
std::vector<Eye> eyesIn(const Scene& scene, const GlareOptions& options) {
  const Vec3 up = glm::normalize(scene.up), height = options.eyeHeight / scene.metresPerUnit * up;
  std::vector<Eye> eyes;
  for (const ProbePoint& p : options.place.grid(scene).points)
    for (const Eye& eye : eyesAllRound(p.position + height, Frame(up).tangent, up, options.directions))
      eyes.push_back(eye);
  return eyes;
}

std::string rating(double ugr) {
  if (std::isfinite(ugr)) return fmt::format("{:.1f}", ugr);
  return ugr > 0 ? "without bound: all around is black" : "none: no luminaire is seen";
}

std::string triple(const Vec3& v) {
  const auto shown = [](double x) { return std::abs(x) < 1e-9 ? 0.0 : x; };
  return fmt::format("{:.4g} {:.4g} {:.4g}", shown(v.x), shown(v.y), shown(v.z));
}

void describe(const GlareSource& s) {
  fmt::print("L {:9.4g} cd/m2, {:9.3g} sr, P {:6.2f}", s.luminance, s.solidAngle, s.positionIndex);
}

void describe(const UnifiedGlare& g) {
  fmt::print("UGR {} (background {:.4g} cd/m2, {} luminaires seen)\n", rating(g.rating), g.background,
             g.luminaires.size());
  for (std::size_t i = 0; i < std::min(kListed, g.luminaires.size()); ++i) {
    const LuminaireSeen& l = g.luminaires[i];
    fmt::print("  ");
    describe(l.source);
    fmt::print(", {:.4g} lx at the eye{}  {}\n", l.illuminance, l.small ? ", small" : "", l.name);
  }
}

void describe(const DaylightGlare& g) {
  fmt::print("DGP {:.3f} (Ev {:.4g} lx, {} sources above {:.4g} cd/m2)\n", g.probability, g.illuminance,
             g.sources.size(), g.threshold);
  for (std::size_t i = 0; i < std::min(kListed, g.sources.size()); ++i) {
    fmt::print("  {:2}: ", i + 1);
    describe(g.sources[i]);
    fmt::print(", towards {}\n", triple(g.sources[i].direction));
  }
}

void describe(const std::vector<UnifiedGlare>& all, const Scene& scene, int directions) {
  std::vector<double> ratings;
  for (const UnifiedGlare& g : all) ratings.push_back(g.rating);
  std::ranges::sort(ratings);
  const UnifiedGlare& worst = *std::ranges::max_element(all, {}, &UnifiedGlare::rating);
  fmt::print("{} places, {} directions: UGR at most {}, median {}\n", all.size() / static_cast<std::size_t>(directions),
             directions, rating(worst.rating), rating(ratings[ratings.size() / 2]));
  fmt::print("worst from {} towards {}:\n", triple(worst.eye.position + scene.origin), triple(worst.eye.direction));
  describe(worst);
}

void runGlare(const GlareOptions& options) {
  validate(options);
  Run run("glare", options.run);
  if (!options.json.empty()) checkWritable(options.json);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution = options.source.load(run, options.run, progress, [&](const Scene& scene) {
      options.place.given() ? (void)options.place.grid(scene) : (void)eyeIn(scene, options);
    });
    const Scene& scene = solution.scene();
    GlareSettings settings = options.glare;
    settings.seed = options.run.seed;
    if (options.place.given()) {
      const std::vector<UnifiedGlare> all = unifiedGlare(solution, eyesIn(scene, options), settings, &progress);
      if (!options.json.empty()) writeGlare(options.json, scene, nullptr, all);
      if (!options.run.quiet) describe(all, scene, options.directions);
    } else {
      const Eye eye = eyeIn(scene, options);
      if (!options.task.empty()) settings.task = tripleIn("--task", options.task) - scene.origin;
      const std::vector<UnifiedGlare> unified = unifiedGlare(solution, std::span(&eye, 1), settings, &progress);
      const DaylightGlare daylight = daylightGlare(solution, eye, settings, &progress);
      if (!options.output.empty()) {
        if (imageFormatOf(options.output) != ImageFormat::Png) saveImage(options.output, daylight.picture);
        saveImage(marksOf(options.output), markGlare(daylight, &unified[0]));
      }
      if (!options.json.empty()) writeGlare(options.json, scene, &daylight, unified);
      if (!options.run.quiet) describe(unified[0]), describe(daylight);
    }
  }
  run.finish();
}

}  // namespace

void addGlareCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("glare", "Glare from an eye (UGR, DGP), or the worst UGR on a grid");
  const auto options = std::make_shared<GlareOptions>();
  options->source.add(*command);
  command->add_option("--view", options->view, "From a .vf file, or a view or camera of the scene")->type_name("V");
  CLI::Option* eye = command->add_option("--eye", options->eye, "From there")->type_name("X,Y,Z");
  CLI::Option* towards = command->add_option("--towards", options->towards, "A point on the line of sight");
  towards->type_name("X,Y,Z")->needs(eye);
  eye->needs(towards);
  options->place.add(*command);
  command->add_option("--eye-height", options->eyeHeight, "Of eyes above a grid [m]: 1.2 seated, 1.6 standing")
      ->check(CLI::NonNegativeNumber)
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--directions", options->directions, "Level lines of sight from each point of a grid, all round")
      ->check(CLI::Range(1, 360))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--threshold", options->glare.sources.threshold,
                   "Luminance from which a part of the view is a source of DGP [cd/m2]")
      ->check(CLI::PositiveNumber)
      ->type_name("CD")
      ->capture_default_str();
  command->add_option("--task", options->task, "A place that is looked at: sources are five times as bright as it is")
      ->type_name("X,Y,Z");
  command->add_option("--size", options->glare.size, "Of the fisheye picture's side [pixels]")
      ->check(CLI::Range(64, 4096))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--samples", options->glare.samplesPerPixel, "Rays of a pixel")
      ->check(CLI::Range(1, 1 << 16))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option(
          "-o", options->output,
          "The fisheye picture: .png with sources and luminaires marked; .exr or .hdr, and the marks beside it")
      ->type_name("IMAGE");
  command->add_option("--json", options->json, "Everything that was found")->type_name("FILE.json");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runGlare(*options); });
}

}  // namespace deltalux::cli
