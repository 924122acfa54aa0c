#include <algorithm>
#include <cmath>
#include <deltalux/image_io.hpp>
#include <deltalux/render.hpp>

#include "base/check.hpp"
#include "glare/fisheye.hpp"
#include "glare/luminaires.hpp"
#include "glare/sight_frame.hpp"
#include "render/painter.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr double kBesideSun = 1.01;  // how far rays into a sun's disc are put off its middle, in its radius [defined]
constexpr int kMostProbe = 1 << 18;  // lines or shadow rays of the eye [limit]

/// The direction, or where it lies in the disc of a sun the nearest one beside it.
Vec3 besideSuns(const Scene& scene, Vec3 d) {
  for (const Light& light : scene.lights) {
    const auto* sun = std::get_if<SunLight>(&light.emitter);
    if (!sun) continue;
    const Vec3 off = d - sun->direction;
    const double reach = kBesideSun * 2 * std::sin(0.5 * sun->angularRadius);
    if (glm::dot(off, off) >= reach * reach) continue;
    const Vec3 across = off - glm::dot(off, sun->direction) * sun->direction;
    const Vec3 away = glm::length(across) > 0 ? glm::normalize(across) : Frame(sun->direction).tangent;
    const double angle = kBesideSun * sun->angularRadius;
    d = std::cos(angle) * sun->direction + std::sin(angle) * away;
  }
  return d;
}

Image fisheyeImage(const Solution& s, const Eye& eye, const GlareSettings& settings, Progress* progress) {
  RenderSettings render;
  render.width = render.height = settings.size;
  render.samplesPerPixel = settings.samplesPerPixel, render.seed = settings.seed;
  Image image = rendering::blankImage(s, render);
  const rendering::Reconstruction reconstruction(s);
  const auto ray = [&](double x, double y) {
    double u = 2 * x - 1, v = 1 - 2 * y;
    const double r = std::max(1.0, std::hypot(u, v) * (1 + 1e-9));  // what lies beyond the rim looks along it
    return ViewRay{eye.position, besideSuns(s.scene, fisheyeDirection(eye, u / r, v / r).value())};
  };
  const rendering::Painter painter(s, reconstruction, ray, render);
  rendering::paint(painter, image, progress, "picture",
                   [&](int x, int y) { return glare::fisheyePixel(eye, settings.size, x, y).has_value(); });
  const View view{"", View::Kind::Perspective, eye.position, eye.direction, eye.up, 180, 180};
  image.view = viewOptions(view, s.scene.origin).replace(0, 4, "-vta");
  return image;
}

double thresholdOf(const Image& image, const Eye& eye, const GlareSettings& settings) {
  if (!settings.task) return settings.sources.threshold;
  const Vec3 towards = glm::normalize(*settings.task - eye.position);
  double sum = 0, omega = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto pixel = glare::fisheyePixel(eye, image.width, x, y);
      if (!pixel || glm::dot(pixel->direction, towards) < std::cos(settings.taskAngle)) continue;
      sum += pixel->solidAngle * photometric(glm::dvec3(image.at(x, y)), image.luminousEfficacy);
      omega += pixel->solidAngle;
    }
  return omega > 0 && sum > 0 ? settings.taskContrast * sum / omega : settings.sources.threshold;
}

}  // namespace

DaylightGlare daylightGlare(const SolutionView& solution, const Eye& eye, const GlareSettings& settings,
                            Progress* progress) {
  DELTALUX_CHECK(settings.size > 0 && settings.samplesPerPixel > 0, "a picture has pixels, and each of them rays");
  const Solution& s = solution.get();
  DaylightGlare found;
  found.eye = eye;
  found.picture = fisheyeImage(s, eye, settings, progress);
  found.threshold = thresholdOf(found.picture, eye, settings);
  GlareSourceSettings finding = settings.sources;
  finding.threshold = found.threshold;
  found.sources = glareSources(found.picture, eye, finding, &found.sourceOf);
  // Discs of suns come after those of the picture, whose numbers its pixels have.
  for (const GlareSource& sun : glare::LuminaireMeter(s.scene, *s.tracer).suns(eye)) found.sources.push_back(sun);

  ProbeSettings probing;
  probing.error = settings.error, probing.seed = settings.seed, probing.maxSamples = kMostProbe;
  const ProbePoint at{eye.position, glm::normalize(eye.direction)};
  found.illuminance =
      photometric(probe(solution, std::span(&at, 1), probing, progress)[0].irradiance, s.scene.luminousEfficacy);
  found.probability = daylightGlareProbability(found.sources, found.illuminance);
  return found;
}

}  // namespace deltalux
