// deltalux render: a view of the solution.
#include <fmt/format.h>

#include <charconv>
#include <deltalux/output.hpp>
#include <deltalux/render.hpp>

#include "commands.hpp"
#include "picture_options.hpp"
#include "solution_source.hpp"
#include "view_choice.hpp"

namespace deltalux::cli {

namespace {
constexpr double kFalseColorError = 0.02;  // of a pixel's illuminance: finer than the scale's colours tell apart
constexpr int kFalseColorRays = 1024;

struct RenderOptions {
  SolutionSource source;
  RunOptions run;
  PictureOptions picture;
  std::string view, output, linksOf, textures;
  int samples = RenderSettings{}.samplesPerPixel;
  bool meshDirect = false, mesh = false;
};

/// "X,Y"; nullopt when it does not read so.
std::optional<glm::ivec2> parsePixel(const std::string& text) {
  const char* const end = text.data() + text.size();
  glm::ivec2 p(0);
  const auto [comma, xError] = std::from_chars(text.data(), end, p.x);
  if (xError != std::errc() || comma == end || *comma != ',') return std::nullopt;
  const auto [rest, yError] = std::from_chars(comma + 1, end, p.y);
  if (yError != std::errc() || rest != end || p.x < 0 || p.y < 0) return std::nullopt;
  return p;
}

std::string checkPixel(const std::string& text) {
  return parsePixel(text) ? "" : fmt::format("'{}' should read X,Y: a pixel from the top left", text);
}

/// Irradiance of what each pixel's centre sees [W/m2]; -1 where that is nothing.
Image irradianceSeen(const SolutionView& solution, const View& view, glm::ivec2 size, std::uint64_t seed,
                     Progress& progress) {
  const std::vector<std::optional<ProbePoint>> seen = visiblePoints(solution.scene(), view, size.x, size.y);
  std::vector<ProbePoint> points;
  for (const auto& point : seen)
    if (point) points.push_back(*point);
  ProbeSettings settings;
  settings.error = kFalseColorError, settings.maxSamples = kFalseColorRays, settings.seed = seed;
  const std::vector<ProbeResult> results = probe(solution, points, settings, &progress);
  Image image;
  image.width = size.x, image.height = size.y;
  image.luminousEfficacy = solution.scene().luminousEfficacy;
  image.pixels.reserve(seen.size());
  auto result = results.begin();
  for (const auto& point : seen) image.pixels.push_back(point ? Rgb((result++)->irradiance) : Rgb(-1.0f));
  return image;
}

Image meshImage(const RenderOptions& options, const SolutionView& solution, const View& view, glm::ivec2 size) {
  MeshViewSettings settings;
  settings.width = size.x, settings.height = size.y;
  if (!options.linksOf.empty()) {
    settings.linksOf = parsePixel(options.linksOf);
    if (settings.linksOf->x >= size.x || settings.linksOf->y >= size.y)
      throw CLI::ValidationError(
          fmt::format("--links-of {}: the picture has {} x {} pixels", options.linksOf, size.x, size.y));
  }
  return renderMesh(solution, view, settings);
}

Image picture(const RenderOptions& options, const SolutionView& solution, const View& view, glm::ivec2 size,
              Progress& progress) {
  if (options.mesh) return meshImage(options, solution, view, size);
  RenderSettings settings;
  settings.width = size.x, settings.height = size.y;
  settings.samplesPerPixel = options.samples;
  settings.meshDirect = options.meshDirect;
  settings.seed = options.run.seed;
  return render(solution, view, settings, &progress);
}

/// Every caustic texture as a picture of its own, and all on a contact sheet.
void saveTextures(const std::filesystem::path& folder, const SolutionView& solution, const Run& run) {
  const std::vector<TextureImage> textures = textureImages(solution);
  for (std::size_t i = 0; i < textures.size(); ++i)
    saveImage(folder / fmt::format("{:03}-{}.exr", i + 1, textures[i].name), textures[i].image);
  saveImage(folder / "contact_sheet.png", contactSheet(textures));
  run.say(fmt::format("{}: {} caustic textures", folder.string(), textures.size()));
}

void checkOutputs(const RenderOptions& options) {
  if (options.textures.empty() && options.view.empty())
    throw CLI::ValidationError("--view V with -o IMAGE, or --textures DIR: one of them is required");
  if (!options.textures.empty() && !std::filesystem::is_directory(options.textures))
    throw CLI::ValidationError(fmt::format("--textures {}: there is no such folder", options.textures));
  if (!options.textures.empty()) checkWritable(std::filesystem::path(options.textures) / "contact_sheet.png");
  if (options.view.empty()) return;
  options.picture.validate(options.output);
  checkWritable(options.output);
}

void saveView(const RenderOptions& options, const SolutionView& solution, const View& view, const Run& run,
              Progress& progress) {
  const glm::ivec2 size = options.picture.resolution(view);
  if (options.picture.falseColor()) {
    const Image image = irradianceSeen(solution, view, size, options.run.seed, progress);
    options.picture.saveFalseColor(options.output, image);
  } else {
    Image image = picture(options, solution, view, size, progress);
    image.view = viewOptions(view, solution.scene().origin);
    options.picture.save(options.output, image, run);
  }
  run.say(fmt::format("{}: {} x {} pixels", options.output, size.x, size.y));
}

void runRender(const RenderOptions& options) {
  checkOutputs(options);
  Run run("render", options.run);
  ProgressPrinter progress(options.run.progressStyle());
  std::optional<View> view;
  const SolutionView solution = options.source.load(run, options.run, progress, [&](const Scene& scene) {
    if (!options.view.empty()) view = chooseView(scene, options.view);
  });
  if (!options.textures.empty()) saveTextures(options.textures, solution, run);
  if (view) saveView(options, solution, *view, run, progress);
  run.finish();
}
}  // namespace

void addRenderCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "A view of a solution");
  const auto options = std::make_shared<RenderOptions>();
  options->source.add(*command);
  CLI::Option* view = command->add_option("--view", options->view, "A .vf file, or a view or camera of the scene");
  view->type_name("V");
  CLI::Option* output = command->add_option("-o", options->output, "The picture: .exr, .hdr or .png");
  output->type_name("IMAGE")->needs(view);
  view->needs(output);
  command->add_option("--textures", options->textures, "Every caustic texture into this folder, with a contact sheet")
      ->type_name("DIR");
  CLI::Option* samples = command->add_option("--samples", options->samples, "Camera rays per pixel");
  samples->type_name("N")->check(CLI::Range(1, 1 << 16))->capture_default_str();
  CLI::Option* meshDirect = command->add_flag("--mesh-direct", options->meshDirect,
                                              "Direct light from the mesh, smoothed: faster, softer shadows");
  CLI::Option* mesh = command->add_flag("--mesh", options->mesh, "The bare mesh with outlined patches, for debugging");
  mesh->excludes(samples)->excludes(meshDirect);
  command
      ->add_option("--links-of", options->linksOf,
                   "With --mesh, by --method paper: draw the links of the patch at a pixel")
      ->type_name("X,Y")
      ->check(checkPixel)
      ->needs(mesh);
  options->picture.add(*command, view);
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runRender(*options); });
}

}  // namespace deltalux::cli
